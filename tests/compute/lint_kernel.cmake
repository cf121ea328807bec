# cmake -DCLANG=... -DFILE=kernel.cl -DINCLUDES=.../kernels -P lint_kernel.cmake: compiles one kernel, without output,
# at every LANES, STORAGE, RSM_RECORDS and ES_FMA, warnings as errors. Helpers and arguments that one of these
# has no use for are no fault.
file(STRINGS ${FILE} USES_RSM REGEX "rsm.clh")
set(RECORDS_CHOICES 1)
if(USES_RSM)
  set(RECORDS_CHOICES 0 1)
endif()
foreach(LANES IN ITEMS 1 4 8 16)
  foreach(STORAGE IN ITEMS 0 1 2)
    foreach(RSM_RECORDS IN LISTS RECORDS_CHOICES)
      foreach(ES_FMA IN ITEMS 0 1)
        set(DEFINES -DLANES=${LANES} -DSTORAGE=${STORAGE} -DRSM_RECORDS=${RSM_RECORDS} -DES_FMA=${ES_FMA})
        execute_process(
          COMMAND ${CLANG} -x cl -cl-std=CL1.2 -fsyntax-only -Xclang -finclude-default-header
            -Wall -Wextra -Wshadow -Wdouble-promotion -Werror
            -Wno-unused-function -Wno-unused-parameter -Wno-unused-variable
            -DES_DIALECT_CL ${DEFINES} -I${INCLUDES}/common -I${INCLUDES}/shared ${FILE}
          RESULT_VARIABLE RESULT)
        if(NOT RESULT EQUAL 0)
          message(FATAL_ERROR "${FILE} with ${DEFINES}")
        endif()
      endforeach()
    endforeach()
  endforeach()
endforeach()
