# Sources that compile together: most of a source's time goes into the headers of Eigen, the C++ library
# and GoogleTest, and into what it instantiates of them again. CMake's own batches do not know which
# sources have names in common; groups.py does.

# beltrami_list_sources(FOLDER): adds to beltrami_listed a line for each target of a folder of CMake's
# and of those below, its name and its sources.
macro(beltrami_list_sources folder)
  get_property(targets DIRECTORY ${folder} PROPERTY BUILDSYSTEM_TARGETS)
  foreach(target IN LISTS targets)
    get_target_property(kind ${target} TYPE)
    if(NOT kind MATCHES "^(EXECUTABLE|(OBJECT|STATIC|SHARED|MODULE)_LIBRARY)$")
      continue()
    endif()
    get_target_property(listed ${target} SOURCES)
    get_target_property(place ${target} SOURCE_DIR)
    list(FILTER listed INCLUDE REGEX "\\.cpp$")
    string(APPEND beltrami_listed ${target})
    foreach(source IN LISTS listed)
      get_filename_component(source ${source} ABSOLUTE BASE_DIR ${place})
      string(APPEND beltrami_listed "\t${source}")
      # A name that is new in one source may part it from others.
      set_property(DIRECTORY ${PROJECT_SOURCE_DIR} APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${source})
    endforeach()
    string(APPEND beltrami_listed "\n")
  endforeach()
  get_property(folders DIRECTORY ${folder} PROPERTY SUBDIRECTORIES)
  foreach(inner IN LISTS folders)
    beltrami_list_sources(${inner})
  endforeach()
endmacro()

# Unites the sources of every target of the project.
function(beltrami_unite)
  set(beltrami_listed "")
  beltrami_list_sources(${PROJECT_SOURCE_DIR})
  file(WRITE ${PROJECT_BINARY_DIR}/sources.txt "${beltrami_listed}")
  execute_process(COMMAND ${Python3_EXECUTABLE} -B ${PROJECT_SOURCE_DIR}/cmake/groups.py
    ${PROJECT_BINARY_DIR}/sources.txt ${PROJECT_BINARY_DIR}/groups.txt
    OUTPUT_VARIABLE groups COMMAND_ERROR_IS_FATAL ANY)
  # A line for each group.
  string(REGEX MATCHALL "[^\n]+" groups "${groups}")
  foreach(group IN LISTS groups)
    string(REPLACE "\t" ";" group "${group}")
    list(POP_FRONT group target)
    # Named after its first source, so that a group keeps its object where another comes or goes.
    list(GET group 0 first)
    cmake_path(RELATIVE_PATH first BASE_DIRECTORY ${PROJECT_SOURCE_DIR})
    string(MAKE_C_IDENTIFIER "${first}" first)
    set_source_files_properties(${group} TARGET_DIRECTORY ${target} PROPERTIES UNITY_GROUP ${first})
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  endforeach()
endfunction()
