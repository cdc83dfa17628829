# cmake -D DOCUMENT=FILE -D TOOL_DIR=DIR -D WORK=DIR -P commands.cmake
# Runs what the blocks of shell commands in a document say, line by line, in the empty folder WORK.
cmake_minimum_required(VERSION 3.25)
include(${CMAKE_CURRENT_LIST_DIR}/blocks.cmake)

# Lines that are not run here: what they do is tested elsewhere, or changes the machine. Anything else that is no
# command of the tool fails, so that no new line goes untested unseen.
set(elsewhere "^(\\./demo|\\./check( --full)?|git clone [^ ]+|sudo apt(-get)? install [^;&|]+|cmake (-S|-B|--preset|--build|--install) [^;&|]+|cd [a-z]+)$")

file(REMOVE_RECURSE ${WORK})
file(MAKE_DIRECTORY ${WORK})
set(ENV{PATH} "${TOOL_DIR}:$ENV{PATH}")

# How long `compare` and `bench` measure, how much they ask, and large pictures of paths are cut to what shows that
# they work.
function(run command)
  if(command MATCHES "^hedgerow compare ")
    string(REGEX REPLACE " --(time|queries) [0-9.]+" "" command "${command}")
    string(APPEND command " --time 0.001 --queries 100")
  elseif(command MATCHES "^hedgerow bench")
    string(REPLACE " --quick" "" command "${command}")
    string(APPEND command " --quick --rounds 1")
  elseif(command MATCHES "^hedgerow render .* --shading path ")
    string(REGEX REPLACE " --size [0-9][0-9][0-9]+x[0-9]+" " --size 64x48" command "${command}")
    string(REGEX REPLACE " --spp [0-9][0-9][0-9]+" " --spp 8" command "${command}")
  endif()
  execute_process(COMMAND sh -c "${command}" WORKING_DIRECTORY ${WORK} RESULT_VARIABLE result
                  OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "${DOCUMENT}:${line}: exit status ${result} of\n  ${command}\n${output}")
  endif()
  # What a command writes is there.
  if(command MATCHES " -o ([^ ]+)")
    set(written ${WORK}/${CMAKE_MATCH_1})
    if(NOT EXISTS ${written})
      message(FATAL_ERROR "${DOCUMENT}:${line}: no ${CMAKE_MATCH_1} was written by\n  ${command}")
    endif()
  endif()
  message(STATUS "${DOCUMENT}:${line}: ${command}")
endfunction()

# The documents' own scenes, where a reader of the repository has them, and names for a reader's own files.
file(COPY ${CMAKE_CURRENT_LIST_DIR}/../../docs/scenes DESTINATION ${WORK}/docs)
set(line 0)
run("hedgerow generate gen:teapot:5000 -o dragon.ply")

markdown_blocks(${DOCUMENT} "sh;bash;shell;console" block)
if(block_COUNT EQUAL 0)
  return()
endif()
math(EXPR last "${block_COUNT} - 1")
foreach(i RANGE ${last})
  # In a console block "$ " marks a command and the rest is output; in the others every line is a command.
  set(text "${block_${i}_TEXT}")
  set(line ${block_${i}_LINE})
  string(SUBSTRING "${text}" 1 -1 text)  # the end of the fence's line
  string(FIND "\n${text}" "\n$ " prompted)
  while(NOT text STREQUAL "")
    string(FIND "${text}" "\n" end)
    string(SUBSTRING "${text}" 0 ${end} command)
    math(EXPR end "${end} + 1")
    string(SUBSTRING "${text}" ${end} -1 text)
    string(REGEX REPLACE "[ \t]+#.*$" "" command "${command}")
    string(STRIP "${command}" command)
    if(NOT prompted EQUAL -1 AND NOT command MATCHES "^\\$ ")
      set(command "")
    endif()
    string(REGEX REPLACE "^\\$ " "" command "${command}")
    if(command MATCHES "\\\\$")
      message(FATAL_ERROR "${DOCUMENT}:${line}: a command of several lines, which this test does not read")
    elseif(command MATCHES "^hedgerow ")
      run("${command}")
    elseif(NOT command STREQUAL "" AND NOT command MATCHES "^#" AND NOT command MATCHES "${elsewhere}")
      message(FATAL_ERROR "${DOCUMENT}:${line}: neither a command of the tool nor one that ${CMAKE_CURRENT_LIST_FILE} "
                          "passes over:\n  ${command}")
    endif()
    math(EXPR line "${line} + 1")
  endwhile()
endforeach()
