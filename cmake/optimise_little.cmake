# What g++ takes a third as long to compile as at -O3, and what loses little by it: it is run for seconds, or calls the
# libraries, which do the work and are compiled at -O3 (as clang compiles everything).
function(hedgerow_optimise_little target)
  target_compile_options(${target} PRIVATE $<$<AND:$<CONFIG:Release>,$<CXX_COMPILER_ID:GNU>>:-Og>)
endfunction()
