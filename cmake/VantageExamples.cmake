# The numbered programs under examples/, each built against what it says it links and run as a test.

# vantage_example(NAME LIBRARY PATTERN): PATTERN is what the program has to print.
function(vantage_example name library pattern)
  add_executable(${name} ${PROJECT_SOURCE_DIR}/examples/${name}.cpp)
  target_link_libraries(${name} PRIVATE ${library} vantage_build_settings)
  set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/examples)
  add_test(NAME Example.${name} COMMAND ${CMAKE_COMMAND} -DPROGRAM=$<TARGET_FILE:${name}> -DPATTERN=${pattern}
                                        -P ${PROJECT_SOURCE_DIR}/tests/expect_output.cmake)
  set_tests_properties(Example.${name} PROPERTIES LABELS default TIMEOUT 120)
endfunction()

vantage_example(01_plan_a_view vantage::core "scan 3: .*next view [0-9]+: best of 80")
vantage_example(02_keep_the_robot_safe vantage::core "are feasible.*workspace")
if(VANTAGE_APPS)
  vantage_example(03_reconstruct_in_simulation vantage::simulation "covered after [0-9]+ scans")
  vantage_example(04_your_own_robot vantage::simulation "finished: ")

  # Every place of the arm's moves is checked once more by a program that shares no code with the library.
  add_executable(05_an_arm_around_a_mug ${PROJECT_SOURCE_DIR}/examples/05_an_arm_around_a_mug.cpp)
  target_link_libraries(05_an_arm_around_a_mug PRIVATE vantage::simulation vantage_build_settings)
  set_target_properties(05_an_arm_around_a_mug PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/examples)
  add_executable(check_arm_moves ${PROJECT_SOURCE_DIR}/tests/arm/check_moves.cpp)
  target_link_libraries(check_arm_moves PRIVATE fcl urdfdom::urdfdom_model vantage_build_settings)
  add_test(NAME Example.05_an_arm_around_a_mug
    COMMAND ${PROJECT_SOURCE_DIR}/tests/arm/check.sh $<TARGET_FILE:05_an_arm_around_a_mug> $<TARGET_FILE:check_arm_moves>
            ${PROJECT_SOURCE_DIR}/examples)
  set_tests_properties(Example.05_an_arm_around_a_mug PROPERTIES LABELS slow TIMEOUT 600)
endif()
