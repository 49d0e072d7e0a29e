# Fails unless PROGRAM ends with exit code 0 and prints what PATTERN describes. (ctest's PASS_REGULAR_EXPRESSION would
# not look at the exit code.)
execute_process(COMMAND ${PROGRAM} OUTPUT_VARIABLE output ECHO_OUTPUT_VARIABLE RESULT_VARIABLE result)
if(NOT result EQUAL 0)
  message(FATAL_ERROR "exit code ${result}")
endif()
if(NOT output MATCHES "${PATTERN}")
  message(FATAL_ERROR "the output does not match: ${PATTERN}")
endif()
