# cmake -D TYPE=BUILD_TYPE -D WORK=DIR -D SOURCE=DIR -D OPTIONS=... -P added.cmake
# Configures, links and runs added/ with a build type, or with none. What is compiled is kept for the next run.
cmake_minimum_required(VERSION 3.25)

execute_process(COMMAND ${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR}/added -B ${WORK} ${OPTIONS}
                        -DCMAKE_BUILD_TYPE=${TYPE} -DHEDGEROW=${SOURCE}
                OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${CMAKE_COMMAND} --build ${WORK} --parallel 2 --target added COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${WORK}/added OUTPUT_VARIABLE printed COMMAND_ERROR_IS_FATAL ANY)
if(NOT printed STREQUAL "hit\n")
  message(FATAL_ERROR "the consumer printed '${printed}'")
endif()
