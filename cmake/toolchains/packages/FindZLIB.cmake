# The half of zlib that compresses, of its source, for targets that have no zlib of their own.
set(zlib ${BELTRAMI_DIST}/zlib)
set(ZLIB_FOUND FALSE)
if(EXISTS ${zlib}/deflate.c)
  add_library(beltrami_zlib STATIC ${zlib}/adler32.c ${zlib}/crc32.c ${zlib}/deflate.c ${zlib}/trees.c ${zlib}/zutil.c)
  target_include_directories(beltrami_zlib SYSTEM PUBLIC ${zlib})
  # Its functions are older than prototypes, and it takes any Apple for a Mac of the last century, which lacks fdopen.
  target_compile_options(beltrami_zlib PRIVATE -w $<$<PLATFORM_ID:Darwin>:-Dfdopen=fdopen>)
  add_library(ZLIB::ZLIB ALIAS beltrami_zlib)
  set(ZLIB_FOUND TRUE)
endif()
