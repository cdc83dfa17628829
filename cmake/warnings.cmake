# The warnings that every target of the project is free of.
function(hedgerow_warnings target)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wshadow -Wconversion
                                           $<$<BOOL:${HEDGEROW_WERROR}>:-Werror>)
endfunction()
