# cmake -D HOW=core|installed|subdirectory -D WORK=DIR -D SOURCE=DIR [-D BINARY=DIR -D COMPILER=g++] -D OPTIONS=...
#       -P check.cmake
# Builds the consumer in WORK: with core alone in every variant, whose outputs must be the same, else in one.
#
# As a subdirectory core and io are compiled again: without optimisation, which is quicker, and in a folder that is
# kept for the next run.
cmake_minimum_required(VERSION 3.25)

function(run)
  execute_process(COMMAND ${ARGN} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

if(HOW STREQUAL "subdirectory")
  list(APPEND OPTIONS -DCMAKE_BUILD_TYPE= -DHEDGEROW_SOURCE=${SOURCE} -DHEDGEROW_COMPONENTS=core,io)
else()
  file(REMOVE_RECURSE ${WORK}/prefix ${WORK}/installed ${WORK}/build)
  set(components core)
  if(HOW STREQUAL "installed")
    list(APPEND components any io tool)
  endif()
  foreach(component ${components})
    run(${CMAKE_COMMAND} --install ${BINARY} --prefix ${WORK}/installed --component ${component})
  endforeach()
  # Moved after it is installed, and no path of the build in it: a package can be unpacked anywhere.
  file(RENAME ${WORK}/installed ${WORK}/prefix)
  file(GLOB_RECURSE written ${WORK}/prefix/*.cmake ${WORK}/prefix/*.pc)
  foreach(file ${written})
    file(READ ${file} text)
    foreach(path ${SOURCE} ${BINARY})
      string(FIND "${text}" "${path}" at)
      if(NOT at EQUAL -1)
        message(FATAL_ERROR "${file} names ${path}")
      endif()
    endforeach()
  endforeach()
  foreach(document README.md docs/api.md docs/pictures/ray.svg examples/instances.cpp)
    if(NOT EXISTS ${WORK}/prefix/share/doc/hedgerow/${document})
      message(FATAL_ERROR "${document} is not installed")
    endif()
  endforeach()
  string(REPLACE ";" "," components "${components}")
  list(APPEND OPTIONS -DCMAKE_PREFIX_PATH=${WORK}/prefix "-DHEDGEROW_COMPONENTS=${components}")
endif()

set(variants plain)
if(HOW STREQUAL "core")
  list(APPEND variants unoptimised native native_contracted)
endif()
string(REPLACE ";" "," names "${variants}")

run(${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR} -B ${WORK}/build ${OPTIONS} -DVARIANTS=${names})
run(${CMAKE_COMMAND} --build ${WORK}/build --parallel 2)
foreach(variant IN LISTS variants)
  execute_process(COMMAND ${WORK}/build/${variant} OUTPUT_VARIABLE printed COMMAND_ERROR_IS_FATAL ANY)
  if(printed STREQUAL "")
    message(FATAL_ERROR "${variant} printed nothing")
  endif()
  if(variant STREQUAL "plain")
    set(expected "${printed}")
  elseif(NOT printed STREQUAL expected)
    file(WRITE ${WORK}/plain.txt "${expected}")
    file(WRITE ${WORK}/${variant}.txt "${printed}")
    message(FATAL_ERROR "the consumer's variant ${variant} prints other bits than plain: compare the .txt files in ${WORK}")
  endif()
endforeach()

# What is installed is found by pkg-config too.
if(HOW STREQUAL "core")
  file(GLOB_RECURSE package ${WORK}/prefix/*/hedgerow-core.pc)
  get_filename_component(folder ${package} DIRECTORY)
  set(ENV{PKG_CONFIG_PATH} ${folder})
  run(sh -c "'${COMPILER}' -std=c++20 '${CMAKE_CURRENT_LIST_DIR}/added/main.cpp' -o by_pkg_config \
             $(pkg-config --cflags --libs hedgerow-core) && ./by_pkg_config | grep -qx hit" WORKING_DIRECTORY ${WORK})
endif()
