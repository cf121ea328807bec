# cmake -DSOURCE=... -DOUT=... -P revision.cmake: what of the repository is built, as `git describe` says it, into a
# header; which is left alone where that did not change. "unknown" outside a checkout.
cmake_minimum_required(VERSION 3.23)
set(REVISION unknown)
find_program(GIT git)
if(GIT AND EXISTS ${SOURCE}/.git)
  execute_process(COMMAND ${GIT} describe --always --dirty WORKING_DIRECTORY ${SOURCE}
    OUTPUT_VARIABLE DESCRIBED OUTPUT_STRIP_TRAILING_WHITESPACE RESULT_VARIABLE RESULT ERROR_QUIET)
  if(RESULT EQUAL 0 AND DESCRIBED)
    set(REVISION ${DESCRIBED})
  endif()
endif()
file(CONFIGURE OUTPUT ${OUT} CONTENT "#pragma once
// Made by bench/revision.cmake.
namespace earthshine::bench {
inline constexpr const char* kRevision = \"@REVISION@\";
}
" @ONLY)
