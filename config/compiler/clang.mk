# clang has no warnings of its own that we ask for.
compiler_warnings =
