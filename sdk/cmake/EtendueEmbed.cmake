# etendue_embed(TARGET NAME files...): the files, one after the other, as `extern const unsigned char NAME[]; extern const unsigned NAME_size;` in
# namespace etendue::embedded. Bytes instead of string literals: those have limits of length, and of what may stand in them.
if(CMAKE_SCRIPT_MODE_FILE)
  string(REPLACE "|" ";" INPUTS "${INPUTS}")
  set(hex "")
  foreach(file IN LISTS INPUTS)
    file(READ "${file}" part HEX)
    string(APPEND hex "${part}")
  endforeach()
  string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${hex}")
  string(REPLACE "0x0a," "0x0a,\n" bytes "${bytes}")
  file(WRITE "${OUTPUT}" "namespace etendue::embedded {\nextern const unsigned char ${NAME}[];\nextern const unsigned ${NAME}_size;\n"
    "const unsigned char ${NAME}[] = {\n${bytes}0};\nconst unsigned ${NAME}_size = sizeof(${NAME}) - 1;\n}  // namespace etendue::embedded\n")
  return()
endif()

set(ETENDUE_EMBED_SCRIPT ${CMAKE_CURRENT_LIST_FILE})
function(etendue_embed target name)
  set(inputs "")
  foreach(file IN LISTS ARGN)
    list(APPEND inputs ${CMAKE_CURRENT_SOURCE_DIR}/${file})
  endforeach()
  set(output ${CMAKE_CURRENT_BINARY_DIR}/embedded_${name}.cpp)
  string(REPLACE ";" "|" joined "${inputs}")  # a semicolon would not survive the command line
  add_custom_command(OUTPUT ${output} COMMAND ${CMAKE_COMMAND} -DNAME=${name} -DOUTPUT=${output} "-DINPUTS=${joined}" -P ${ETENDUE_EMBED_SCRIPT}
                     DEPENDS ${inputs} ${ETENDUE_EMBED_SCRIPT} VERBATIM)
  target_sources(${target} PRIVATE ${output})
endfunction()
