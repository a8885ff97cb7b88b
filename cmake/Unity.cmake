# Sources that compile together: under the sanitizers, too, most of a source's time goes into the
# headers of Eigen, the C++ library and GoogleTest. CMake's own batches do not know which sources
# have names in common; tools/lint/groups.py does.

# beltrami_unite(FOLDER): unites the sources of every target of a folder of CMake's and of those below.
function(beltrami_unite folder)
  get_property(targets DIRECTORY ${folder} PROPERTY BUILDSYSTEM_TARGETS)
  foreach(target IN LISTS targets)
    get_target_property(kind ${target} TYPE)
    if(NOT kind MATCHES "^(EXECUTABLE|(OBJECT|STATIC|SHARED|MODULE)_LIBRARY)$")
      continue()
    endif()
    get_target_property(listed ${target} SOURCES)
    get_target_property(place ${target} SOURCE_DIR)
    list(FILTER listed INCLUDE REGEX "\\.cpp$")
    set(sources "")
    foreach(source IN LISTS listed)
      get_filename_component(source ${source} ABSOLUTE BASE_DIR ${place})
      list(APPEND sources ${source})
    endforeach()
    execute_process(COMMAND ${Python3_EXECUTABLE} -B ${PROJECT_SOURCE_DIR}/tools/lint/groups.py
      ${sources} OUTPUT_VARIABLE groups COMMAND_ERROR_IS_FATAL ANY)
    # A line for each group.
    string(REGEX MATCHALL "[^\n]+" groups "${groups}")
    set(number 0)
    foreach(group IN LISTS groups)
      math(EXPR number "${number} + 1")
      string(REPLACE "\t" ";" group "${group}")
      set_source_files_properties(${group} TARGET_DIRECTORY ${target} PROPERTIES
        UNITY_GROUP together_${number})
    endforeach()
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
    # A name that is new in one source may part it from others.
    set_property(DIRECTORY ${PROJECT_SOURCE_DIR} APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${sources})
  endforeach()
  get_property(below DIRECTORY ${folder} PROPERTY SUBDIRECTORIES)
  foreach(inner IN LISTS below)
    beltrami_unite(${inner})
  endforeach()
endfunction()
