# cmake -D COMPILER=g++ -D INCLUDE=DIR -P fast_math.cmake: no header compiles under -ffast-math.
cmake_minimum_required(VERSION 3.25)

# Headers that compute nothing, or nothing of geometry.
set(allowed version.h base/error.h base/column.h base/instruction_set.h nbody/kernels.h base/option.h base/scratch.h base/spelling.h base/bare_vector.h base/stored.h parallel/executor.h parallel/by.h parallel/progress.h
            parallel/blocks.h parallel/radix_sort.h parallel/select.h geometry/morton_code.h base/strided.h base/buffer.h ask/truths.h io/load_options.h io/memory.h io/exr.h io/image.h looks/layers.h io/notes.h io/state_file.h io/npy.h io/rows.h io/text_file.h
            render/lettering.h render/film/around.h
            render/sampling/sobol.h measure/advice.h measure/break_even.h measure/clock.h measure/contest.h measure/costs.h measure/fit.h
            measure/growth.h measure/lists.h measure/machine.h measure/quantity.h measure/reason.h predicted_memory.h io/writable.h parallel/sort.h parallel/watched_executor.h structures/item_limit.h structures/hash_grid/cell_table.h
            walks/engine.h scenes/size_text.h)

file(GLOB_RECURSE headers RELATIVE ${INCLUDE}/hedgerow ${INCLUDE}/hedgerow/*.h)
foreach(header ${headers})
  # Without the standard library's headers, which say nothing to it and take most of the time to read.
  execute_process(COMMAND ${COMPILER} -std=c++20 -ffast-math -MM -MG -nostdinc -x c++ -I ${INCLUDE}
                          ${INCLUDE}/hedgerow/${header}
                  RESULT_VARIABLE result OUTPUT_QUIET ERROR_VARIABLE messages)
  if(NOT header IN_LIST allowed AND (result EQUAL 0 OR NOT messages MATCHES "numerics contract"))
    message(SEND_ERROR "hedgerow/${header} compiles under -ffast-math; let it include <hedgerow/geometry/rounding.h>, "
                       "or, if it computes nothing, name it in ${CMAKE_CURRENT_LIST_FILE}")
  endif()
endforeach()
