# What each linker wants to hear of abi/symbols.txt, the one list of exported functions. Hidden
# visibility is not enough: statically linked libraries would stay exported, and a host's own
# version of them would be called instead.

# beltrami_write_export_lists(FOLDER): beltrami.map (ELF), beltrami.exports (Mach-O), beltrami.def
# (Windows), written only where they changed.
function(beltrami_write_export_lists folder)
  set(list ${PROJECT_SOURCE_DIR}/abi/symbols.txt)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${list})
  file(STRINGS ${list} symbols REGEX "^[a-z]")
  list(TRANSFORM symbols APPEND ";" OUTPUT_VARIABLE elf)
  list(TRANSFORM symbols PREPEND "_" OUTPUT_VARIABLE mach)
  string(REPLACE ";;" ";\n    " elf "${elf}")
  string(REPLACE ";" "\n" mach "${mach}")
  string(REPLACE ";" "\n  " windows "${symbols}")
  file(CONFIGURE OUTPUT ${folder}/beltrami.map CONTENT
    "BELTRAMI_${BELTRAMI_ABI} {\n  global:\n    ${elf}\n  local:\n    *;\n};\n")
  file(CONFIGURE OUTPUT ${folder}/beltrami.exports CONTENT "${mach}\n")
  file(CONFIGURE OUTPUT ${folder}/beltrami.def CONTENT "EXPORTS\n  ${windows}\n")
endfunction()

# beltrami_limit_exports(TARGET FOLDER): exports from a shared library what the lists name.
function(beltrami_limit_exports target folder)
  if(WIN32)
    target_sources(${target} PRIVATE ${folder}/beltrami.def)
    return()
  endif()
  if(APPLE AND BELTRAMI_ZIG)
    # Its linker takes no such list, and its C++ library is hidden but for these; tools/dist/checks.py looks.
    target_sources(${target} PRIVATE ${PROJECT_SOURCE_DIR}/cmake/toolchains/macos_operators.cpp)
    return()
  endif()
  if(APPLE)
    set(file ${folder}/beltrami.exports)
    target_link_options(${target} PRIVATE -Wl,-exported_symbols_list,${file})
  else()
    set(file ${folder}/beltrami.map)
    target_link_options(${target} PRIVATE -Wl,--version-script=${file})
  endif()
  set_property(TARGET ${target} APPEND PROPERTY LINK_DEPENDS ${file})
endfunction()
