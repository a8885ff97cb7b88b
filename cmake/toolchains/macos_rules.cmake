# CMake knows of @rpath by the version of the macOS that it runs on: elsewhere it has to be told.
if(CMAKE_SYSTEM_NAME STREQUAL "Darwin")
  set(CMAKE_SHARED_LIBRARY_RUNTIME_C_FLAG "-Wl,-rpath,")
endif()
