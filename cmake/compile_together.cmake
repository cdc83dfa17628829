# hedgerow_compile_together(TARGET [FILE...]): compiles some 20 files of a target at once, but for those named, since
# the headers that they share (of the library, JSON, CLI11, fmt) take the compiler longer than the files themselves.
function(hedgerow_compile_together target)
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 21)
  set_source_files_properties(${ARGN} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
endfunction()
