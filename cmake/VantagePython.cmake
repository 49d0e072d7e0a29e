# The Python module: build/PRESET/python/vantage, usable with PYTHONPATH, and installed below the prefix.

# Debian's interpreter is the one that Debian's numpy and pybind11 are for.
find_program(Python_EXECUTABLE python3 PATHS /usr/bin NO_DEFAULT_PATH DOC "The interpreter that the module is built for")
set(PYBIND11_FINDPYTHON ON)
find_package(Python 3.9 QUIET COMPONENTS Interpreter Development.Module NumPy)
find_package(pybind11 2.10 QUIET)
if(NOT Python_FOUND OR NOT pybind11_FOUND)
  message(STATUS "The Python module is left out: it needs the Debian packages python3-dev, python3-numpy and pybind11-dev")
  return()
endif()

set(VANTAGE_PYTHON_DIR "" CACHE PATH
  "Where the Python module is installed, below the prefix; lib/pythonX.Y/site-packages of the interpreter where empty")
set(vantage_python_folder ${VANTAGE_PYTHON_DIR})
if(NOT vantage_python_folder)
  set(vantage_python_folder lib/python${Python_VERSION_MAJOR}.${Python_VERSION_MINOR}/site-packages)
endif()

file(GLOB vantage_python_sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/python/src/*.cpp)
# Without link-time optimisation: the library is compiled without it, and what is here only passes calls on.
pybind11_add_module(vantage_python MODULE NO_EXTRAS ${vantage_python_sources})
target_link_libraries(vantage_python PRIVATE vantage_simulation vantage_report vantage_doctor vantage_build_settings)
# What is here only passes calls on: compiling it quickly matters more.
target_compile_options(vantage_python PRIVATE -O1)
target_compile_definitions(vantage_python PRIVATE VANTAGE_VERSION="${PROJECT_VERSION}")
set_target_properties(vantage_python PROPERTIES OUTPUT_NAME _vantage
  UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 5  # most of the time goes into pybind11's headers
  LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/python/vantage)
file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/python/vantage)
foreach(file __init__.py __init__.pyi py.typed)
  file(CREATE_LINK ${PROJECT_SOURCE_DIR}/python/vantage/${file} ${PROJECT_BINARY_DIR}/python/vantage/${file}
    COPY_ON_ERROR SYMBOLIC)
endforeach()

if(VANTAGE_INSTALL AND NOT VANTAGE_WHEEL)
  # Packages for Debian go where its interpreter looks; decided when it is installed, because the prefix is known then.
  install(CODE "set(vantage_python_folder \"${vantage_python_folder}\")
    if(CMAKE_INSTALL_PREFIX STREQUAL \"/usr\" AND \"${VANTAGE_PYTHON_DIR}\" STREQUAL \"\")
      set(vantage_python_folder lib/python3/dist-packages)
    endif()" COMPONENT python)
  install(TARGETS vantage_python LIBRARY DESTINATION "\${vantage_python_folder}/vantage" COMPONENT python)
  install(FILES python/vantage/__init__.py python/vantage/__init__.pyi python/vantage/py.typed
    DESTINATION "\${vantage_python_folder}/vantage" COMPONENT python)
endif()

# A wheel (setup.py) holds the module and the program, side by side in the package's folder, and nothing else.
if(VANTAGE_WHEEL)
  install(TARGETS vantage_python LIBRARY DESTINATION vantage)
  install(TARGETS vantage RUNTIME DESTINATION vantage/bin)
endif()
