# cmake -DOCLGRIND=... -DPROGRAM=... -DFILTER=... -DCHECKS=... -P run_oclgrind.cmake: runs some tests of a GoogleTest
# program in Oclgrind; fails if one fails, if none ran, or if Oclgrind has anything to report, which goes to stderr.
execute_process(
  # Unoptimised: clang's optimiser leaves intrinsics in kernels that Oclgrind 21.10 does not know.
  COMMAND ${OCLGRIND} --build-options -cl-opt-disable --max-errors 20 ${CHECKS} ${PROGRAM} --gtest_filter=${FILTER}
  RESULT_VARIABLE RESULT OUTPUT_VARIABLE OUTPUT ERROR_VARIABLE REPORT)
if(NOT RESULT EQUAL 0 OR NOT OUTPUT MATCHES "OK.*SmallFrame.*/Oclgrind" OR NOT REPORT STREQUAL "")
  message(FATAL_ERROR "exit code ${RESULT}\n${REPORT}\n${OUTPUT}")
endif()
