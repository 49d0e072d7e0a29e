# The Python module's tests and its example, run with the interpreter that it is built for.
if(NOT TARGET vantage_python)
  return()
endif()

set(python_environment ${CMAKE_COMMAND} -E env PYTHONPATH=${PROJECT_BINARY_DIR}/python PYTHONDONTWRITEBYTECODE=1
  VANTAGE_PROGRAM=$<TARGET_FILE:vantage> VANTAGE_SHARED_DATA=${VANTAGE_SHARED_DATA} ${Python_EXECUTABLE})
foreach(name vantage planning stubs)
  add_test(NAME Python.${name} COMMAND ${python_environment} ${PROJECT_SOURCE_DIR}/python/tests/test_${name}.py)
  set_tests_properties(Python.${name} PROPERTIES LABELS default TIMEOUT 600)
endforeach()
set(session_test_in_python ${python_environment} ${PROJECT_SOURCE_DIR}/python/tests/test_session.py)
add_test(NAME Python.session COMMAND ${session_test_in_python} Sessions Depths)
set_tests_properties(Python.session PROPERTIES LABELS default TIMEOUT 600)
# RealScans.test_ur5_tray takes minutes more: by hand.
add_test(NAME Python.session_of_real_scans COMMAND ${session_test_in_python} RealScans.test_apc_shelf)
set_tests_properties(Python.session_of_real_scans PROPERTIES LABELS slow TIMEOUT 2400)
add_test(NAME Example.plan_in_python COMMAND ${python_environment} ${PROJECT_SOURCE_DIR}/examples/plan_in_python.py)
set_tests_properties(Example.plan_in_python PROPERTIES LABELS default TIMEOUT 120
  PASS_REGULAR_EXPRESSION "scan 3: .*view [0-9]+ is best of 80.*as many occplane voxels as possible: view [0-9]+")
add_test(NAME Example.session_in_python
  COMMAND ${python_environment} ${PROJECT_SOURCE_DIR}/examples/session_in_python.py)
set_tests_properties(Example.session_in_python PROPERTIES LABELS default TIMEOUT 120
  PASS_REGULAR_EXPRESSION "first: [0-9]+ new occupied.*4 of 4 scans merged.*written: .*map.nrrd.*report.html")
