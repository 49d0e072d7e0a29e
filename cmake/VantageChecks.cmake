# Checks of the project as a whole: its layers, its documents, and its use from other projects.

# A sanitizer's runtime would have to be linked into the consumer, and changes nothing about the repository.
if(VANTAGE_SANITIZE)
  return()
endif()

find_package(Python3 3.9 REQUIRED COMPONENTS Interpreter)

# vantage_check(NAME COMMAND...)
function(vantage_check name)
  add_test(NAME ${name} COMMAND ${ARGN} WORKING_DIRECTORY ${PROJECT_SOURCE_DIR})
  set_tests_properties(${name} PROPERTIES LABELS checks TIMEOUT 600)
endfunction()

set(repository ${PROJECT_SOURCE_DIR}/tests/repository)
set(python ${CMAKE_COMMAND} -E env PYTHONDONTWRITEBYTECODE=1 ${Python3_EXECUTABLE})
vantage_check(Repository.IncludesObeyTheLayers ${python} ${repository}/layers.py .)
vantage_check(Repository.LayerCheckCatchesForbiddenIncludes ${python} ${repository}/layers_test.py)
vantage_check(Repository.FilesAreShortAndFitAnyMachine ${python} ${repository}/repository.py .)
vantage_check(Repository.FileCheckFindsWhatItShould ${python} ${repository}/repository_test.py)
vantage_check(Repository.NoTypeIsDefinedTwice ${python} ${repository}/definitions.py .)
vantage_check(Repository.DefinitionCheckFindsWhatItShould ${python} ${repository}/definitions_test.py)
vantage_check(Repository.NoNamesMeetInJoinedFiles ${python} ${repository}/joined_names.py .)
vantage_check(Repository.JoinedNameCheckFindsWhatItShould ${python} ${repository}/joined_names_test.py)
vantage_check(Repository.TextsUseTheWordsOfTheField ${python} ${repository}/english.py .)
vantage_check(Repository.EnglishCheckFindsWhatItShould ${python} ${repository}/english_test.py)
vantage_check(Repository.DocumentCheckFindsWhatItShould ${python} ${repository}/documents_test.py)
if(VANTAGE_APPS)
  vantage_check(Repository.DocumentsNameWhatExists ${python} ${repository}/documents.py . $<TARGET_FILE:vantage>)
endif()

set(consumer ${CMAKE_COMMAND} -DCONSUMER=${PROJECT_SOURCE_DIR}/tests/consumer -DCXX=${CMAKE_CXX_COMPILER})
set(check -P ${PROJECT_SOURCE_DIR}/tests/consumer/check.cmake)
vantage_check(Consumer.FindsTheInstalledPackage ${consumer} -DBUILD=${PROJECT_BINARY_DIR}
              -DWORK=${PROJECT_BINARY_DIR}/consumer/installed ${check})
if(VANTAGE_APPS)
  vantage_check(Consumer.FindsAllComponents ${consumer} -DBUILD=${PROJECT_BINARY_DIR} -DFULL=ON
                -DWORK=${PROJECT_BINARY_DIR}/consumer/full ${check})
  vantage_check(Consumer.KeepsASessionWithoutTheSimulation ${consumer} -DBUILD=${PROJECT_BINARY_DIR} -DSESSION=ON
                -DWORK=${PROJECT_BINARY_DIR}/consumer/session ${check})
endif()
# Compiles the planner once more.
vantage_check(Consumer.EmbedsTheSource ${consumer} -DSOURCE=${PROJECT_SOURCE_DIR}
              -DWORK=${PROJECT_BINARY_DIR}/consumer/embedded ${check})
set_tests_properties(Consumer.EmbedsTheSource PROPERTIES LABELS slow TIMEOUT 1800)
# The listings of the README, against the package that the consumer test before it has installed.
if(TARGET vantage_python)
  add_test(NAME Readme.ListingsRun COMMAND ${Python3_EXECUTABLE} ${PROJECT_SOURCE_DIR}/tests/cli/readme_test.py
    $<TARGET_FILE:vantage> ${PROJECT_SOURCE_DIR}/README.md ${PROJECT_BINARY_DIR}/python
    ${PROJECT_BINARY_DIR}/consumer/session/prefix)
  set_tests_properties(Consumer.KeepsASessionWithoutTheSimulation PROPERTIES FIXTURES_SETUP installed_session)
  set_tests_properties(Readme.ListingsRun PROPERTIES LABELS default TIMEOUT 600 FIXTURES_REQUIRED installed_session)
endif()

# Packages in a fresh Debian, and a wheel in a fresh virtual environment. The first needs root and a mirror of Debian, and
# is skipped elsewhere.
if(VANTAGE_APPS AND TARGET vantage_python)
  add_test(NAME Packages.InstallRunAndLeave
    COMMAND ${PROJECT_SOURCE_DIR}/tests/packages/check.sh ${PROJECT_BINARY_DIR} ${PROJECT_SOURCE_DIR})
  add_test(NAME Packages.Wheel COMMAND ${PROJECT_SOURCE_DIR}/tests/packages/pip_check.sh ${PROJECT_SOURCE_DIR}
    ${PROJECT_BINARY_DIR}/wheel ${PROJECT_BINARY_DIR})
  set_tests_properties(Packages.InstallRunAndLeave Packages.Wheel PROPERTIES LABELS slow TIMEOUT 2400 SKIP_RETURN_CODE 77)
endif()
