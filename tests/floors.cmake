# cmake -D ROOT=DIR -P floors.cmake: scripts/floors passes on the headers as they are, and names an include that goes up, a
# room that the map lacks and one that it has too many.
cmake_minimum_required(VERSION 3.25)

function(expect_fault what)
  execute_process(COMMAND ${ROOT}/scripts/floors ${copy} RESULT_VARIABLE result ERROR_VARIABLE messages)
  if(result EQUAL 0 OR NOT messages MATCHES "${what}")
    message(SEND_ERROR "not found: ${what}\nrc ${result}: ${messages}")
  endif()
endfunction()

execute_process(COMMAND ${ROOT}/scripts/floors RESULT_VARIABLE result)
if(NOT result EQUAL 0)
  message(SEND_ERROR "the headers do not keep to their floors")
endif()

set(copy ${CMAKE_CURRENT_BINARY_DIR}/floors)
file(REMOVE_RECURSE ${copy})
file(COPY ${ROOT}/include ${ROOT}/ARCHITECTURE.md DESTINATION ${copy})
file(APPEND ${copy}/include/hedgerow/geometry/vec.h "#include <hedgerow/index.h>\n")
file(WRITE ${copy}/include/hedgerow/cellar/new.h "#pragma once\n")
file(REMOVE_RECURSE ${copy}/include/hedgerow/instances)
expect_fault("geometry/vec.h:[0-9]+: includes index.h, which stands on a lower floor")
expect_fault("cellar/new.h: ARCHITECTURE.md names no floor for cellar/")
expect_fault("there is no instances/")
file(REMOVE_RECURSE ${copy})
