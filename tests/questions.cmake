# cmake -D ROOT=DIR -P questions.cmake: scripts/questions passes on the headers as they are, lists what asks, and names a
# function whose arguments stand in another order and one that the table of docs/api.md lacks.
cmake_minimum_required(VERSION 3.25)

execute_process(COMMAND ${ROOT}/scripts/questions RESULT_VARIABLE result OUTPUT_VARIABLE listed)
if(NOT result EQUAL 0)
  message(SEND_ERROR "a question is asked in another way than the others")
endif()
foreach(line "closest_hits\\(index, asked, out, options, filter, visits\\)" "overlap_counts\\(" "hausdorff_distance\\(")
  if(NOT listed MATCHES "${line}")
    message(SEND_ERROR "not listed: ${line}")
  endif()
endforeach()

set(copy ${CMAKE_CURRENT_BINARY_DIR}/questions)
file(REMOVE_RECURSE ${copy})
file(COPY ${ROOT}/include/hedgerow/ask DESTINATION ${copy}/include/hedgerow)
file(COPY ${ROOT}/docs/api.md DESTINATION ${copy}/docs)
file(APPEND ${copy}/include/hedgerow/ask/points.h "
namespace hedgerow {
template <class I>
std::size_t nearest(const I& index, const PointOptions& options, std::size_t k) {
    return k;
}
template <class I>
bool second_point(const I& index, const PointOf<I>& point) {
    return true;
}
}  // namespace hedgerow
")
execute_process(COMMAND ${ROOT}/scripts/questions ${copy} RESULT_VARIABLE result OUTPUT_QUIET ERROR_VARIABLE messages)
foreach(what "points.h: nearest has its arguments in another order" "the table of docs/api.md lacks second_point")
  if(result EQUAL 0 OR NOT messages MATCHES "${what}")
    message(SEND_ERROR "not found: ${what}\nrc ${result}: ${messages}")
  endif()
endforeach()
file(REMOVE_RECURSE ${copy})
