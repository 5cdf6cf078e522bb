# clang takes INFINITY and NAN for floats that are promoted; gcc's -Wdouble-promotion decides.  psabi
# tells of vectors as arguments, which are inlined here.
compiler_warnings = -Wno-double-promotion -Wno-psabi
