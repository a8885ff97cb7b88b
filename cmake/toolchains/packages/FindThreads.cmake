# CMake's own; WebAssembly has one thread, and needs nothing for it.
if(BELTRAMI_ZIG_TARGET MATCHES "wasi")
  add_library(Threads::Threads INTERFACE IMPORTED)
  set(Threads_FOUND TRUE)
else()
  include(${CMAKE_ROOT}/Modules/FindThreads.cmake)
endif()
