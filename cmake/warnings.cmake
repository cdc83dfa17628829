# The warnings that every target of the project is free of.
function(hedgerow_warnings target)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wshadow -Wconversion
                                           $<$<BOOL:${HEDGEROW_WERROR}>:-Werror>)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # psabi notes an ABI change of g++ 4.6; g++ 12 warns of -Wrestrict inside std::string (its bug 105651).
    target_compile_options(${target} PRIVATE -Wno-psabi)
    if(CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
      target_compile_options(${target} PRIVATE -Wno-restrict)
    endif()
  endif()
endfunction()
