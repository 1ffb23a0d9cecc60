# Text files into a C++ source at build time, one {"name", R"(text)"} a line in the order of the names.
#   topple_embed(TEMPLATE in OUTPUT out [BASE folder] [WITH_EXTENSION] FILES file...)
# The template says @EMBEDDED@ where the entries go. A name is the path from BASE, or the file's own name,
# without extension unless WITH_EXTENSION.

if(NOT CMAKE_SCRIPT_MODE_FILE)
  set(TOPPLE_EMBED_SCRIPT ${CMAKE_CURRENT_LIST_FILE})

  function(topple_embed)
    cmake_parse_arguments(arg "WITH_EXTENSION" "TEMPLATE;OUTPUT;BASE" "FILES" ${ARGN})
    string(REPLACE ";" "|" files "${arg_FILES}")
    add_custom_command(
      OUTPUT ${arg_OUTPUT}
      COMMAND ${CMAKE_COMMAND} -DTEMPLATE=${arg_TEMPLATE} -DOUTPUT=${arg_OUTPUT} -DFILES=${files} -DBASE=${arg_BASE}
              -DWITH_EXTENSION=${arg_WITH_EXTENSION}
              -P ${TOPPLE_EMBED_SCRIPT}
      DEPENDS ${arg_FILES} ${arg_TEMPLATE} ${TOPPLE_EMBED_SCRIPT}
      VERBATIM)
  endfunction()
  return()
endif()

cmake_minimum_required(VERSION 3.25)
string(REPLACE "|" ";" files "${FILES}")
list(SORT files)
set(EMBEDDED "")
foreach(file IN LISTS files)
  get_filename_component(name ${file} NAME_WLE)
  if(BASE)
    file(RELATIVE_PATH name ${BASE} ${file})
    string(REGEX REPLACE "\\.[^.]*$" "" name ${name})
  endif()
  if(WITH_EXTENSION)
    get_filename_component(name ${file} NAME)
  endif()
  file(READ ${file} text)
  string(APPEND EMBEDDED "      {\"${name}\", R\"embedded(${text})embedded\"},\n")
endforeach()
file(READ ${TEMPLATE} source)
string(REPLACE "@EMBEDDED@" "${EMBEDDED}" source "${source}")
file(WRITE ${OUTPUT} "${source}")
