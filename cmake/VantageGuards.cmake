# Checks of what the core costs, neither of which depends on the clock: its peak memory and its instructions.

add_executable(core_memory ${PROJECT_SOURCE_DIR}/tests/memory/core_memory.cpp)
target_link_libraries(core_memory PRIVATE vantage_core vantage_build_settings)
target_include_directories(core_memory PRIVATE ${PROJECT_SOURCE_DIR}/tests)

add_executable(vantage_instructions ${PROJECT_SOURCE_DIR}/benchmarks/instructions/instructions.cpp)
target_link_libraries(vantage_instructions PRIVATE vantage_core vantage_build_settings)
target_include_directories(vantage_instructions PRIVATE ${PROJECT_SOURCE_DIR}/tests)

# Sanitizers bring memory and instructions of their own, and other builds have other instructions.
if(NOT VANTAGE_SANITIZE)
  add_test(NAME CoreMemory COMMAND core_memory)
  set_tests_properties(CoreMemory PROPERTIES LABELS default TIMEOUT 240 SKIP_RETURN_CODE 77)
endif()
if(NOT VANTAGE_SANITIZE AND CMAKE_BUILD_TYPE STREQUAL "Release" AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  find_package(Python3 REQUIRED COMPONENTS Interpreter)
  add_test(NAME Instructions
    COMMAND Python3::Interpreter ${PROJECT_SOURCE_DIR}/benchmarks/instructions/check.py $<TARGET_FILE:vantage_instructions>)
  set_tests_properties(Instructions PROPERTIES LABELS "slow;guard" TIMEOUT 600 SKIP_RETURN_CODE 77)
endif()
