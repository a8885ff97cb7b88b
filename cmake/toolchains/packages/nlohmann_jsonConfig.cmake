# Headers alone, apart from those of the machine's C library.
set(nlohmann_json_FOUND TRUE)
add_library(nlohmann_json::nlohmann_json INTERFACE IMPORTED)
target_include_directories(nlohmann_json::nlohmann_json INTERFACE ${BELTRAMI_DIST}/include)
