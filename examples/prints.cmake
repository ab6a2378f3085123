# Runs COMMAND (a list) and holds what it prints to the file EXPECTED.
string(REPLACE "|" ";" COMMAND "${COMMAND}")
execute_process(COMMAND ${COMMAND} OUTPUT_VARIABLE found RESULT_VARIABLE status)
file(READ ${EXPECTED} expected)
if(NOT status EQUAL 0 OR NOT found STREQUAL expected)
  message(FATAL_ERROR "exit status ${status}; expected ${EXPECTED}:\n${expected}\nfound:\n${found}")
endif()
