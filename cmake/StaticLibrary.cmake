# The static library. A plain archive hands the final link every template instance of Eigen, CGAL
# and the C++ library, as weak symbols: a host that compiles the same templates with other flags
# (-ffast-math) would lend us its versions, or get ours. So where GNU ld is at hand all objects are
# linked into one, in which only the names of abi/symbols.txt are global.

# beltrami_add_static_library(TARGET MEMORY OBJECT_LIBRARY...): MEMORY is for a library whose operators
# new and delete no other code sees.
function(beltrami_add_static_library target memory)
  set(one FALSE)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_SYSTEM_NAME STREQUAL "Linux" AND CMAKE_OBJCOPY
     AND NOT CMAKE_INTERPROCEDURAL_OPTIMIZATION)
    set(one TRUE)
  elseif(NOT (BELTRAMI_ZIG AND CMAKE_SYSTEM_NAME STREQUAL "Linux")) # tools/dist/static_library.py
    set(memory beltrami_system_memory)
  endif()
  list(PREPEND ARGN ${memory})
  foreach(library IN LISTS ARGN)
    # CMake counts a precompiled header among them.
    list(APPEND objects $<FILTER:$<TARGET_OBJECTS:${library}>,EXCLUDE,gch$|pch$>)
  endforeach()
  set(one_object ${CMAKE_CURRENT_BINARY_DIR}/${target}${CMAKE_CXX_OUTPUT_EXTENSION})
  set(symbols ${PROJECT_SOURCE_DIR}/abi/symbols.txt)
  if(one)
    # Groups are dissolved, or the final link would still merge them by their names.
    add_custom_command(OUTPUT ${one_object}
      COMMAND ${CMAKE_CXX_COMPILER} -r -nostdlib -Wl,--force-group-allocation -o ${one_object}
              ${objects}
      COMMAND ${CMAKE_OBJCOPY} --keep-global-symbols=${symbols} --strip-debug ${one_object}
      DEPENDS ${objects} ${symbols} COMMAND_EXPAND_LISTS VERBATIM
      COMMENT "Linking the objects of the static library into one")
    add_library(${target} STATIC ${one_object})
    add_dependencies(${target} ${ARGN}) # Makefiles do not see that the objects are these targets'
    set_source_files_properties(${one_object} PROPERTIES EXTERNAL_OBJECT TRUE GENERATED TRUE)
    set_target_properties(${target} PROPERTIES LINKER_LANGUAGE CXX)
  else()
    add_library(${target} STATIC ${objects})
  endif()
  # Its file has the shared library's name where the suffixes differ.
  if(NOT WIN32 OR NOT BUILD_SHARED_LIBS)
    set_target_properties(${target} PROPERTIES OUTPUT_NAME beltrami)
  endif()
  # What is left open in the archive, by name; the package configuration finds it where it lies.
  target_link_libraries(${target} INTERFACE Threads::Threads)
  if(BELTRAMI_SOLVER MATCHES "^cholmod")
    target_link_libraries(${target} INTERFACE
      $<BUILD_INTERFACE:${CHOLMOD_LIBRARY}> $<INSTALL_INTERFACE:beltrami::cholmod>)
  endif()
  if(BELTRAMI_SIMPLIFIER STREQUAL "openmesh")
    target_link_libraries(${target} INTERFACE $<BUILD_INTERFACE:OpenMeshTools>
      $<INSTALL_INTERFACE:beltrami::OpenMeshTools> $<INSTALL_INTERFACE:beltrami::OpenMeshCore>)
  endif()
  # For programs in C, whose linker does not think of them.
  if(UNIX)
    target_link_libraries(${target} INTERFACE
      $<$<NOT:$<LINK_LANGUAGE:CXX>>:${BELTRAMI_CXX_RUNTIME}> m)
  endif()
endfunction()
