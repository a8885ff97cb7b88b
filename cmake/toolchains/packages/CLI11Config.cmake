# Headers alone, apart from those of the machine's C library.
set(CLI11_FOUND TRUE)
add_library(CLI11::CLI11 INTERFACE IMPORTED)
target_include_directories(CLI11::CLI11 INTERFACE ${BELTRAMI_DIST}/include)
