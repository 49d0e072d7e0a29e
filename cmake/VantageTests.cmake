# One test program per folder, from the *_test.cpp files beside the sources. Files named *_slow_test.cpp go into the
# labelled set that `ctest -L slow` runs and that the default run leaves out.

find_package(GTest REQUIRED)
include(GoogleTest)
option(VANTAGE_SLOW_TESTS "Build the slow tests too" ON)
set(VANTAGE_SHARED_DATA "${PROJECT_SOURCE_DIR}/../shared/data" CACHE PATH
  "Folder with object meshes and real scans; tests that need it skip where it does not exist")

# vantage_folder_tests(FOLDER LIBRARY...): tests of src/vantage/FOLDER linked to the given libraries.
function(vantage_folder_tests folder)
  vantage_test_program(${folder}_test "${PROJECT_SOURCE_DIR}/src/vantage/${folder}" ${ARGN})
endfunction()

function(vantage_test_program name directory)
  file(GLOB fast CONFIGURE_DEPENDS ${directory}/*_test.cpp)
  set(slow ${fast})
  list(FILTER fast EXCLUDE REGEX "_slow_test\\.cpp$")
  list(FILTER slow INCLUDE REGEX "_slow_test\\.cpp$")
  vantage_add_tests(${name} "default" 240 "${fast}" ${ARGN})
  if(VANTAGE_SLOW_TESTS)
    vantage_add_tests(${name}_slow "slow" 2400 "${slow}" ${ARGN})
  endif()
endfunction()

function(vantage_add_tests name label seconds sources)
  if(NOT sources)
    return()
  endif()
  add_executable(${name} ${sources})
  target_link_libraries(${name} PRIVATE ${ARGN} vantage_build_settings GTest::gmock GTest::gtest_main)
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR}/tests)
  target_compile_definitions(${name} PRIVATE VANTAGE_SHARED_DATA="${VANTAGE_SHARED_DATA}")
  gtest_discover_tests(${name} DISCOVERY_TIMEOUT 120 PROPERTIES LABELS ${label} TIMEOUT ${seconds})
endfunction()

foreach(folder core sensor map candidates visibility robot utility search planning)
  vantage_folder_tests(${folder} vantage_core)
endforeach()
if(VANTAGE_APPS)
  vantage_folder_tests(registration vantage_registration)
  vantage_folder_tests(simulation vantage_simulation)
  vantage_folder_tests(model vantage_model)
  vantage_folder_tests(arm vantage_arm)
  target_compile_definitions(arm_test PRIVATE VANTAGE_EXAMPLES="${PROJECT_SOURCE_DIR}/examples")
  find_package(octomap REQUIRED)
  find_package(tinyxml2 REQUIRED)
  foreach(folder files formats recordings)
    vantage_folder_tests(${folder} vantage_formats liblzf::liblzf octomap PNG::PNG fmt::fmt)
  endforeach()
  foreach(folder formats recordings)
    target_compile_definitions(${folder}_test PRIVATE VANTAGE_FUZZ_CORPUS="${PROJECT_SOURCE_DIR}/fuzz/corpus")
  endforeach()
  target_compile_definitions(recordings_test PRIVATE VANTAGE_BAGS="${PROJECT_SOURCE_DIR}/tests/recordings/fixtures")
  foreach(folder options runs session)
    vantage_folder_tests(${folder} vantage_session fmt::fmt)
  endforeach()
  target_compile_definitions(options_test PRIVATE VANTAGE_EXAMPLES="${PROJECT_SOURCE_DIR}/examples")
  vantage_folder_tests(report vantage_report tinyxml2::tinyxml2 fmt::fmt)
  vantage_folder_tests(doctor vantage_doctor vantage_simulation fmt::fmt)
  vantage_folder_tests(experiments vantage_experiments tinyxml2::tinyxml2 fmt::fmt)
  add_library(vantage_readers_under_test STATIC ${PROJECT_SOURCE_DIR}/fuzz/file_readers.cpp
    ${PROJECT_SOURCE_DIR}/fuzz/option_readers.cpp ${PROJECT_SOURCE_DIR}/fuzz/bag_readers.cpp)
  target_include_directories(vantage_readers_under_test PUBLIC ${PROJECT_SOURCE_DIR}/fuzz)
  target_link_libraries(vantage_readers_under_test PUBLIC vantage_server vantage_experiments vantage_doctor fmt::fmt PRIVATE vantage_build_settings)
  target_compile_definitions(vantage_readers_under_test PRIVATE VANTAGE_EXAMPLES="${PROJECT_SOURCE_DIR}/examples")
  target_compile_definitions(vantage_readers_under_test INTERFACE VANTAGE_FUZZ_CORPUS="${PROJECT_SOURCE_DIR}/fuzz/corpus")
  vantage_test_program(fuzz_corpus_test ${PROJECT_SOURCE_DIR}/fuzz vantage_readers_under_test)
  vantage_test_program(apps_test ${PROJECT_SOURCE_DIR}/apps/vantage vantage_experiments CLI11::CLI11 fmt::fmt)
  target_sources(apps_test PRIVATE ${PROJECT_SOURCE_DIR}/apps/vantage/plan_table.cpp
    ${PROJECT_SOURCE_DIR}/apps/vantage/manual.cpp)
  # Debian's cpp-httplib has no CMake file; its pkg-config file says with which definitions it was compiled, and the sizes
  # of its classes depend on them.
  find_path(VANTAGE_HTTPLIB_INCLUDE httplib.h REQUIRED)
  add_library(vantage_httplib INTERFACE)
  target_compile_definitions(vantage_httplib INTERFACE
    CPPHTTPLIB_OPENSSL_SUPPORT CPPHTTPLIB_ZLIB_SUPPORT CPPHTTPLIB_BROTLI_SUPPORT)
  target_include_directories(vantage_httplib SYSTEM INTERFACE ${VANTAGE_HTTPLIB_INCLUDE})
  target_link_libraries(vantage_httplib INTERFACE cpp-httplib)
  vantage_folder_tests(server vantage_server vantage_httplib fmt::fmt)
endif()
include(VantageExamples)
include(VantagePythonTests)
include(VantageChecks)
include(VantageGuards)

# A second evaluator that shares no code with the library checks what `vantage evaluate` says of a dumped map.
if(VANTAGE_APPS)
  add_executable(second_evaluator ${PROJECT_SOURCE_DIR}/tests/evaluator/second_evaluator.cpp)
  target_link_libraries(second_evaluator PRIVATE nlohmann_json::nlohmann_json vantage_build_settings)
  add_test(NAME second_evaluator.agrees
    COMMAND ${PROJECT_SOURCE_DIR}/tests/evaluator/check.sh $<TARGET_FILE:vantage> $<TARGET_FILE:second_evaluator>)
  set_tests_properties(second_evaluator.agrees PROPERTIES LABELS default TIMEOUT 240)
endif()

# The program as a user sees it: exit codes, messages, files.
if(VANTAGE_APPS)
  add_test(NAME command_line COMMAND /usr/bin/python3 ${PROJECT_SOURCE_DIR}/tests/cli/cli_test.py $<TARGET_FILE:vantage>)
  set_tests_properties(command_line PROPERTIES LABELS default TIMEOUT 240)
  add_test(NAME command_line.output
    COMMAND /usr/bin/python3 ${PROJECT_SOURCE_DIR}/tests/cli/output_test.py $<TARGET_FILE:vantage>)
  set_tests_properties(command_line.output PROPERTIES LABELS default TIMEOUT 480)
  add_test(NAME command_line.other_versions COMMAND /usr/bin/python3
    ${PROJECT_SOURCE_DIR}/tests/cli/earlier_version_test.py $<TARGET_FILE:vantage> ${PROJECT_SOURCE_DIR}/tests/data)
  set_tests_properties(command_line.other_versions PROPERTIES LABELS default TIMEOUT 480)
  set(experiment_test /usr/bin/python3 ${PROJECT_SOURCE_DIR}/tests/cli/experiment_test.py $<TARGET_FILE:vantage>)
  add_test(NAME experiments_fail_well COMMAND ${experiment_test} Failures)
  set_tests_properties(experiments_fail_well PROPERTIES LABELS default TIMEOUT 240)
  add_test(NAME experiments_survive_kills COMMAND ${experiment_test} Kills)
  set_tests_properties(experiments_survive_kills PROPERTIES LABELS slow TIMEOUT 1200)
  add_test(NAME experiments_compare COMMAND ${experiment_test} Compare)
  set_tests_properties(experiments_compare PROPERTIES LABELS slow TIMEOUT 1200)
  if(VANTAGE_MPI)
    add_test(NAME experiments_on_ranks COMMAND ${experiment_test} Ranks)
    set_tests_properties(experiments_on_ranks PROPERTIES LABELS slow TIMEOUT 1200)
  endif()
endif()

# Sessions that are killed, full disks, and the same answers as `plan`.
if(VANTAGE_APPS)
  set(session_test /usr/bin/python3 ${PROJECT_SOURCE_DIR}/tests/session/session_test.py $<TARGET_FILE:vantage>
    ${VANTAGE_SHARED_DATA})
  add_test(NAME session COMMAND ${session_test} 10)
  set_tests_properties(session PROPERTIES LABELS default TIMEOUT 240)
  # The whole script with 100 also feeds the frames of real scans one by one, which takes minutes: by hand.
  add_test(NAME session.slow COMMAND ${session_test} 100 Kills RealScans.test_apc_shelf)
  set_tests_properties(session.slow PROPERTIES LABELS slow TIMEOUT 2400)
  set(http_test /usr/bin/python3 ${PROJECT_SOURCE_DIR}/tests/session/http_test.py $<TARGET_FILE:vantage>
    ${PROJECT_SOURCE_DIR}/docs/openapi.yaml ${PROJECT_SOURCE_DIR}/src/vantage/server/session_service.cpp
    ${VANTAGE_SHARED_DATA})
  add_test(NAME session.http COMMAND ${http_test} 0 Description Safety Kills SameAsPlan)
  set_tests_properties(session.http PROPERTIES LABELS default TIMEOUT 480)
  add_test(NAME session.hostile COMMAND /usr/bin/python3 ${PROJECT_SOURCE_DIR}/tests/session/hostile_test.py
    $<TARGET_FILE:vantage> ${PROJECT_SOURCE_DIR}/docs/openapi.yaml ${PROJECT_SOURCE_DIR}/src/vantage/server/session_service.cpp
    ${VANTAGE_SHARED_DATA} 0)
  set_tests_properties(session.hostile PROPERTIES LABELS default TIMEOUT 480)
  # By hand VANTAGE_LOAD_SECONDS=60 makes it the minute that docs/sessions.md tells of; SameAsPlan.test_ur5_tray is by
  # hand too.
  add_test(NAME session.http.slow COMMAND ${http_test} 10 Load SameAsPlan.test_apc_shelf)
  set_tests_properties(session.http.slow PROPERTIES LABELS slow TIMEOUT 2400)
endif()

# The same scans as data sets and bags give the same plan; memory does not grow with the length of a recording; frames
# may come in any order.
if(VANTAGE_APPS)
  foreach(test same_plan memory order)
    add_test(NAME recordings.${test} COMMAND /usr/bin/python3 ${PROJECT_SOURCE_DIR}/tests/recordings/${test}_test.py
      $<TARGET_FILE:vantage> ${VANTAGE_SHARED_DATA} 3)
    set_tests_properties(recordings.${test} PROPERTIES LABELS slow TIMEOUT 1200)
  endforeach()
endif()

# Half a minute of fuzzing for each group of readers; it builds them first.
find_program(VANTAGE_FUZZ_CLANG clang++-16)
if(VANTAGE_APPS AND VANTAGE_FUZZ_CLANG AND NOT VANTAGE_SANITIZE)
  add_test(NAME Fuzz.readers COMMAND ${PROJECT_SOURCE_DIR}/fuzz/run 30)
  set_tests_properties(Fuzz.readers PROPERTIES LABELS slow TIMEOUT 2400)
endif()
