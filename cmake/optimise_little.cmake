# For tests: what g++ takes two thirds as long to compile as at -O3, and what runs for seconds. Not for programs that
# people wait for, even if libraries do their work: of an inline function or template that both have, the linker takes
# the program's copy, so the library runs as the program is compiled (docs/design/006-compiled-once.md).
function(hedgerow_optimise_little target)
  target_compile_options(${target} PRIVATE $<$<AND:$<CONFIG:Release>,$<CXX_COMPILER_ID:GNU>>:-Og>)
endfunction()
