# What is installed, and the packages made of it: a runtime, a development and a program component.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

if(CMAKE_BUILD_TYPE MATCHES "^(Release|MinSizeRel)$")
  # The entry points carry debug information for the gate on the types; an installed library not.
  install(CODE "set(CMAKE_INSTALL_DO_STRIP TRUE)" COMPONENT runtime)
endif()

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/beltrami)
if(TARGET beltrami)
  install(TARGETS beltrami EXPORT beltrami-targets
    RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT runtime
    LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT runtime
            NAMELINK_COMPONENT development
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development)
endif()
if(TARGET beltrami_static)
  if(NOT TARGET beltrami)
    set_target_properties(beltrami_static PROPERTIES EXPORT_NAME beltrami)
  endif()
  install(TARGETS beltrami_static EXPORT beltrami-targets
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development)
endif()
install(DIRECTORY include/beltrami
  DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development
  FILES_MATCHING PATTERN "*.h" PATTERN "*.hpp")
install(EXPORT beltrami-targets NAMESPACE beltrami:: DESTINATION ${package_dir}
  COMPONENT development)

set(BELTRAMI_STATIC_NEEDS "")
if(BELTRAMI_SOLVER MATCHES "^cholmod")
  list(APPEND BELTRAMI_STATIC_NEEDS cholmod)
endif()
if(BELTRAMI_SIMPLIFIER STREQUAL "openmesh")
  list(APPEND BELTRAMI_STATIC_NEEDS OpenMeshTools OpenMeshCore)
endif()
set(BELTRAMI_HAS_SHARED FALSE)
set(BELTRAMI_HAS_STATIC FALSE)
if(TARGET beltrami)
  set(BELTRAMI_HAS_SHARED TRUE)
endif()
if(TARGET beltrami_static)
  set(BELTRAMI_HAS_STATIC TRUE)
endif()
if(PROJECT_VERSION_MAJOR EQUAL 0)
  set(compatibility SameMinorVersion)
else()
  set(compatibility SameMajorVersion)
endif()
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/beltrami-config-version.cmake
  COMPATIBILITY ${compatibility})
configure_package_config_file(cmake/beltrami-config.cmake.in
  ${CMAKE_CURRENT_BINARY_DIR}/beltrami-config.cmake
  INSTALL_DESTINATION ${package_dir} NO_SET_AND_CHECK_MACRO)
install(FILES
  ${CMAKE_CURRENT_BINARY_DIR}/beltrami-config.cmake
  ${CMAKE_CURRENT_BINARY_DIR}/beltrami-config-version.cmake
  DESTINATION ${package_dir} COMPONENT development)

# pkg-config: relative to where the file lies, so that the folder can be moved.
set(BELTRAMI_PC_PRIVATE "-l${BELTRAMI_CXX_RUNTIME} -lm ${CMAKE_THREAD_LIBS_INIT}")
if(BELTRAMI_SOLVER MATCHES "^cholmod")
  string(PREPEND BELTRAMI_PC_PRIVATE "-lcholmod ")
endif()
if(BELTRAMI_SIMPLIFIER STREQUAL "openmesh")
  string(PREPEND BELTRAMI_PC_PRIVATE "-lOpenMeshTools -lOpenMeshCore ")
endif()
string(STRIP "${BELTRAMI_PC_PRIVATE}" BELTRAMI_PC_PRIVATE)
set(BELTRAMI_PC_LIBS "-lbeltrami")
if(NOT TARGET beltrami)
  string(APPEND BELTRAMI_PC_LIBS " ${BELTRAMI_PC_PRIVATE}")
endif()
file(RELATIVE_PATH BELTRAMI_PC_PREFIX
  ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig ${CMAKE_INSTALL_PREFIX})
string(REGEX REPLACE "/$" "" BELTRAMI_PC_PREFIX "${BELTRAMI_PC_PREFIX}")
configure_file(cmake/beltrami.pc.in ${CMAKE_CURRENT_BINARY_DIR}/beltrami.pc @ONLY)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/beltrami.pc
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT development)

if(TARGET beltrami_program)
  if(UNIX)
    set(here "$ORIGIN")
    if(APPLE)
      set(here "@loader_path")
    endif()
    file(RELATIVE_PATH to_libraries ${CMAKE_INSTALL_FULL_BINDIR} ${CMAKE_INSTALL_FULL_LIBDIR})
    set(places "${here}/${to_libraries}")
    if(BELTRAMI_ZIG)
      list(APPEND places "${here}/..") # in a wheel
    endif()
    set_target_properties(beltrami_program PROPERTIES INSTALL_RPATH "${places}")
  endif()
  install(TARGETS beltrami_program
    RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT program)
endif()

# The manual page, and what shells complete by: the program prints them, so it has to run here.
if(TARGET beltrami_program AND PROJECT_IS_TOP_LEVEL AND UNIX AND NOT CMAKE_CROSSCOMPILING)
  set(pages ${CMAKE_CURRENT_BINARY_DIR}/pages)
  file(MAKE_DIRECTORY ${pages})
  set(printed "")
  foreach(arguments "beltrami.1 --man" "beltrami.bash completions bash" "_beltrami completions zsh"
      "beltrami.fish completions fish")
    separate_arguments(arguments)
    list(POP_FRONT arguments name)
    add_custom_command(OUTPUT ${pages}/${name}
      COMMAND beltrami_program ${arguments} > ${pages}/${name} VERBATIM)
    list(APPEND printed ${pages}/${name})
  endforeach()
  add_custom_target(beltrami_pages ALL DEPENDS ${printed})
  install(FILES ${pages}/beltrami.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT program)
  install(FILES ${pages}/beltrami.bash RENAME beltrami
    DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions COMPONENT program)
  install(FILES ${pages}/_beltrami
    DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions COMPONENT program)
  install(FILES ${pages}/beltrami.fish
    DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d COMPONENT program)
endif()

# All of it, and nothing else: what has to be built before it can be installed.
add_custom_target(beltrami_installed)
foreach(target beltrami beltrami_static beltrami_program beltrami_pages)
  if(TARGET ${target})
    add_dependencies(beltrami_installed ${target})
  endif()
endforeach()

# The other components need the runtime one, so these come with all of them.
set(doc_dir ${CMAKE_INSTALL_DATADIR}/doc/beltrami)
install(FILES LICENSE DESTINATION ${doc_dir} COMPONENT runtime)
install(DIRECTORY licenses DESTINATION ${doc_dir} COMPONENT runtime)
install(FILES docs/reference.md CHANGELOG.md DESTINATION ${doc_dir} COMPONENT development)

if(NOT PROJECT_IS_TOP_LEVEL)
  return()
endif()
set(CPACK_GENERATOR TGZ DEB)
set(CPACK_PACKAGE_VENDOR "The beltrami authors")
set(CPACK_PACKAGE_CONTACT "The beltrami authors <beltrami@example.org>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
set(CPACK_PACKAGE_FILE_NAME
  beltrami-${PROJECT_VERSION}-${CMAKE_SYSTEM_NAME}-${CMAKE_SYSTEM_PROCESSOR})
set(CPACK_COMPONENTS_ALL runtime development)
if(TARGET beltrami_program)
  list(APPEND CPACK_COMPONENTS_ALL program)
endif()
set(CPACK_STRIP_FILES TRUE)
set(CPACK_THREADS 0)
# One archive with everything, but a .deb for each component.
set(CPACK_ARCHIVE_COMPONENT_INSTALL OFF)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${PROJECT_BINARY_DIR}/src)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_NAME libbeltrami${BELTRAMI_ABI})
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SECTION libs)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libbeltrami-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SHLIBDEPS OFF)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
  "libbeltrami${BELTRAMI_ABI} (= ${PROJECT_VERSION})")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME beltrami)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_DEPENDS "libbeltrami${BELTRAMI_ABI} (= ${PROJECT_VERSION})")
set(CPACK_DEBIAN_ENABLE_COMPONENT_DEPENDS OFF)
set(CPACK_COMPONENT_RUNTIME_DESCRIPTION "The shared library.")
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION
  "Headers, static library, CMake package and pkg-config file.")
set(CPACK_COMPONENT_PROGRAM_DESCRIPTION "The command-line program.")
include(CPack)
