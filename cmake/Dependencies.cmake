# What is built with, found in one place: what is missing is named with the Debian package that has
# it, all at once. docs/dependencies.md says what each is for.
set(beltrami_missing "")
macro(beltrami_need found what package)
  if(NOT ${found})
    string(APPEND beltrami_missing "\n  ${what} is missing: install ${package}.")
  endif()
endmacro()

find_package(Threads REQUIRED)
find_package(Eigen3 3.4 QUIET NO_MODULE)
beltrami_need(Eigen3_FOUND "Eigen 3.4 or newer" libeigen3-dev)
# Headers alone: its number types without GMP and MPFR, which nothing here needs.
set(CGAL_DISABLE_GMP TRUE)
set(CGAL_DO_NOT_WARN_ABOUT_CMAKE_BUILD_TYPE TRUE)
find_package(CGAL 5.5 QUIET)
beltrami_need(CGAL_FOUND "CGAL 5.5 or newer" libcgal-dev)

set(beltrami_cholmod FALSE)
if(BELTRAMI_SOLVER MATCHES "^cholmod" OR BELTRAMI_BENCH_CHOLMOD)
  find_path(CHOLMOD_INCLUDE_DIR cholmod.h PATH_SUFFIXES suitesparse)
  find_library(CHOLMOD_LIBRARY cholmod)
  if(CHOLMOD_INCLUDE_DIR AND CHOLMOD_LIBRARY)
    set(beltrami_cholmod TRUE)
  endif()
  beltrami_need(beltrami_cholmod "CHOLMOD" libsuitesparse-dev)
endif()
# Tests and benchmarks compare its decimater with ours where it is at hand. By its own package: that
# which CGAL has for finding it does not know the targets.
if(BELTRAMI_SIMPLIFIER STREQUAL "openmesh")
  find_package(OpenMesh QUIET NO_MODULE GLOBAL) # whoever links the static library needs it
  beltrami_need(OpenMesh_FOUND "OpenMesh" libopenmesh-dev)
elseif(BELTRAMI_BUILD_TESTS)
  find_package(OpenMesh QUIET NO_MODULE)
endif()

if(BELTRAMI_BUILD_PROGRAM)
  find_package(CLI11 QUIET)
  beltrami_need(CLI11_FOUND "CLI11" libcli11-dev)
  find_package(nlohmann_json 3.2 QUIET)
  beltrami_need(nlohmann_json_FOUND "JSON for Modern C++ 3.2 or newer" nlohmann-json3-dev)
  find_path(STB_INCLUDE_DIR stb_image_write.h PATH_SUFFIXES stb)
  beltrami_need(STB_INCLUDE_DIR "The image writer of stb" libstb-dev)
endif()
if(BELTRAMI_BUILD_TESTS)
  find_package(GTest QUIET)
  beltrami_need(GTest_FOUND "GoogleTest" libgtest-dev)
  find_package(Python3 3.9 QUIET COMPONENTS Interpreter)
  beltrami_need(Python3_FOUND "Python 3.9 or newer, which the tests run," python3)
endif()

if(beltrami_missing)
  message(FATAL_ERROR "The packages that these sentences name are Debian's:${beltrami_missing}")
endif()
