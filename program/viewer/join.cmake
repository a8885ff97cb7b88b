# Joins the viewer into one page, and writes its bytes for the program to hold.
#
#   cmake -DPAGE=report.html -DBYTES=report_page.inc -P join.cmake
#
# PAGE has two places left, @report@ for JSON and @arrays@ for arrays. The modules share one scope in it: each comes
# behind those that it imports, and a name is of one of them.
cmake_minimum_required(VERSION 3.22)

set(modules geometry cameras figures grid renderer viewer report)

set(viewer "")
foreach(module IN LISTS modules)
  file(READ ${CMAKE_CURRENT_LIST_DIR}/${module}.mjs text)
  string(REGEX REPLACE "\nimport [^\n]*;" "" text "\n${text}")
  string(REPLACE "\nexport " "\n" text "${text}")
  string(APPEND viewer "${text}")
endforeach()
file(READ ${CMAKE_CURRENT_LIST_DIR}/viewer.css style)
file(READ ${CMAKE_CURRENT_LIST_DIR}/report.html page)
string(REPLACE "@viewer.css@" "${style}" page "${page}")
string(REPLACE "@viewer@" "${viewer}" page "${page}")
set(before "")
if(EXISTS ${PAGE} AND EXISTS ${BYTES})
  file(READ ${PAGE} before)
endif()
if(page STREQUAL before)
  return() # so that nothing is compiled again
endif()
file(WRITE ${PAGE} "${page}")

file(READ ${PAGE} bytes HEX)
string(REGEX REPLACE "(..)" "0x\\1," bytes "${bytes}")
string(REGEX REPLACE "(................................................................................)" "\\1\n" bytes "${bytes}")
file(WRITE ${BYTES} "${bytes}\n")
