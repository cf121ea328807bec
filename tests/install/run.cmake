# cmake -DBUILD=build folder -DSOURCE=tests/install -DWORK=scratch -P run.cmake: installs the library beside the build, builds a
# user's project against the installed package alone, and runs it.
file(REMOVE_RECURSE ${WORK})
foreach(COMMAND IN ITEMS
    "${CMAKE_COMMAND};--install;${BUILD}/host;--prefix;${WORK}/prefix"
    "${CMAKE_COMMAND};-G;Ninja;-S;${SOURCE};-B;${WORK}/build;-DCMAKE_PREFIX_PATH=${WORK}/prefix;-DCMAKE_CXX_FLAGS=${FLAGS}"
    "${CMAKE_COMMAND};--build;${WORK}/build"
    "${WORK}/build/user")
  execute_process(COMMAND ${COMMAND} RESULT_VARIABLE RESULT)
  if(NOT RESULT EQUAL 0)
    message(FATAL_ERROR "failed (${RESULT}): ${COMMAND}")
  endif()
endforeach()
