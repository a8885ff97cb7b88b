# Toolchain file: zig's clang, libc++ and C library for any target. tools/dist/dist.py gives what it asks for:
#   BELTRAMI_ZIG          path of zig
#   BELTRAMI_ZIG_TARGET   such as x86_64-linux-gnu.2.17
#   BELTRAMI_DIST         folder with include/ (headers of CLI11, JSON for Modern C++ and so on) and zlib/ (its source)
#   BELTRAMI_RUNTIME      of WebAssembly: folder with the C++ library that tools/dist/wasm/runtime.py makes
set(CMAKE_TRY_COMPILE_PLATFORM_VARIABLES BELTRAMI_ZIG BELTRAMI_ZIG_TARGET BELTRAMI_DIST BELTRAMI_RUNTIME)
if(BELTRAMI_ZIG_TARGET MATCHES "^([a-z0-9_]+)-([a-z]+)")
  set(CMAKE_SYSTEM_PROCESSOR ${CMAKE_MATCH_1})
  if(CMAKE_MATCH_2 STREQUAL "linux")
    set(CMAKE_SYSTEM_NAME Linux)
  elseif(CMAKE_MATCH_2 STREQUAL "windows")
    set(CMAKE_SYSTEM_NAME Windows)
  elseif(CMAKE_MATCH_2 STREQUAL "macos")
    set(CMAKE_SYSTEM_NAME Darwin)
    set(CMAKE_SYSTEM_VERSION 20)
  else()
    set(CMAKE_SYSTEM_NAME Generic) # wasi
  endif()
else()
  message(FATAL_ERROR "BELTRAMI_ZIG_TARGET is '${BELTRAMI_ZIG_TARGET}': give the like of x86_64-linux-gnu.2.17")
endif()

# A file for each tool: CMake calls a compiler by one name.
set(tools ${CMAKE_BINARY_DIR}/zig)
if(CMAKE_BINARY_DIR MATCHES "^(.*)/CMakeFiles/CMakeScratch" OR CMAKE_BINARY_DIR MATCHES "^(.*)/CMakeFiles/CMakeTmp")
  set(tools ${CMAKE_MATCH_1}/zig)
elseif(NOT EXISTS ${tools}/objcopy)
  foreach(tool cc c++)
    file(WRITE ${tools}/${tool} "#!/bin/sh\nexec '${BELTRAMI_ZIG}' ${tool} -target ${BELTRAMI_ZIG_TARGET} \"$@\"\n")
  endforeach()
  foreach(tool ar ranlib rc dlltool objcopy)
    file(WRITE ${tools}/${tool} "#!/bin/sh\nexec '${BELTRAMI_ZIG}' ${tool} \"$@\"\n")
  endforeach()
  file(CHMOD_RECURSE ${tools} PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE)
endif()
set(CMAKE_C_COMPILER ${tools}/cc)
set(CMAKE_CXX_COMPILER ${tools}/c++)
set(CMAKE_AR ${tools}/ar CACHE FILEPATH "")
set(CMAKE_RANLIB ${tools}/ranlib CACHE FILEPATH "")
set(CMAKE_RC_COMPILER ${tools}/rc)
set(CMAKE_DLLTOOL ${tools}/dlltool CACHE FILEPATH "")
# CMake asks Xcode for these; zig brings its own.
set(CMAKE_OSX_SYSROOT "" CACHE STRING "")
set(CMAKE_OSX_DEPLOYMENT_TARGET "" CACHE STRING "")
set(CMAKE_USER_MAKE_RULES_OVERRIDE ${CMAKE_CURRENT_LIST_DIR}/macos_rules.cmake)
set(CMAKE_INSTALL_NAME_TOOL "/bin/true" CACHE FILEPATH "")
# An installed file is as it was linked: the linker strips, and leaves no path of this machine.
set(CMAKE_STRIP "/bin/true" CACHE FILEPATH "")
set(CMAKE_BUILD_WITH_INSTALL_RPATH ON)

# /usr/include itself must never be on the path: the headers of the machine's C library lie there.
set(CMAKE_FIND_ROOT_PATH ${BELTRAMI_DIST})
foreach(kind PROGRAM INCLUDE LIBRARY PACKAGE)
  set(CMAKE_FIND_ROOT_PATH_MODE_${kind} NEVER)
endforeach()
foreach(package CLI11 nlohmann_json)
  set(${package}_DIR ${CMAKE_CURRENT_LIST_DIR}/packages CACHE PATH "")
endforeach()
set(STB_INCLUDE_DIR ${BELTRAMI_DIST}/include/stb CACHE PATH "")
set(CMAKE_MODULE_PATH ${CMAKE_CURRENT_LIST_DIR}/packages)

# Without these zig adds debug information of 25 times the size.
set(CMAKE_C_FLAGS_INIT "-g0")
set(CMAKE_CXX_FLAGS_INIT "-g0")
set(CMAKE_SHARED_LINKER_FLAGS_INIT "-s")
set(CMAKE_EXE_LINKER_FLAGS_INIT "-s")
if(BELTRAMI_ZIG_TARGET MATCHES "wasi")
  file(READ ${BELTRAMI_RUNTIME}/flags flags)
  file(READ ${BELTRAMI_RUNTIME}/machine machine)
  # Eigen has none of its ways around GCC's defects, which are in the assembler's language.
  set(CMAKE_CXX_FLAGS_INIT "-g0 ${flags} -fgnuc-version=0 -I${BELTRAMI_DIST}/include")
  set(CMAKE_C_FLAGS_INIT "-g0 ${machine}")
  set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)
endif()
