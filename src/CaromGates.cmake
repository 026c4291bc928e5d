# carom_add_engine(<target> <source>…)
# An engine module, in a folder where no other module is.
function(carom_add_engine target)
  add_library(${target} MODULE ${ARGN})
  target_link_libraries(${target} PRIVATE Carom::engine)
  set_target_properties(${target} PROPERTIES
    PREFIX "" LIBRARY_OUTPUT_DIRECTORY "${CMAKE_CURRENT_BINARY_DIR}/carom/${target}")
endfunction()

# carom_add_gate(NAME <test> MODULE <target> SCENES <scene>… [ENGINE <name>[@<profile>]] [BASELINE <file>])
# A test that passes where the engine meets the gates of the scenes. Scenes are ids, groups (impact/), all, or files;
# files are looked for from the current source folder. The engine is called like its module's file, unless ENGINE says
# otherwise. <test>.xml and <test>.md in the current binary folder are the JUnit report and the summary.
# With BASELINE the values are held against that file, too; the target <test>-baseline writes it.
function(carom_add_gate)
  cmake_parse_arguments(PARSE_ARGV 0 arg "" "NAME;MODULE;ENGINE;BASELINE" "SCENES")
  if(arg_UNPARSED_ARGUMENTS)
    message(FATAL_ERROR "carom_add_gate: unknown arguments: ${arg_UNPARSED_ARGUMENTS}")
  endif()
  foreach(needed NAME MODULE SCENES)
    if(NOT arg_${needed})
      message(FATAL_ERROR "carom_add_gate: ${needed} is missing; "
        "carom_add_gate(NAME test MODULE target SCENES scene… [ENGINE name] [BASELINE file])")
    endif()
  endforeach()
  if(NOT TARGET ${arg_MODULE})
    message(FATAL_ERROR "carom_add_gate: MODULE ${arg_MODULE} is no target")
  endif()
  if(NOT arg_ENGINE)
    set(arg_ENGINE "$<TARGET_FILE_PREFIX:${arg_MODULE}>$<TARGET_FILE_BASE_NAME:${arg_MODULE}>")
  endif()
  set(command Carom::carom check ${arg_SCENES} --engine ${arg_ENGINE}
    --engines-from "$<TARGET_FILE_DIR:${arg_MODULE}>")
  set(reports --junit "${CMAKE_CURRENT_BINARY_DIR}/${arg_NAME}.xml"
    --summary "${CMAKE_CURRENT_BINARY_DIR}/${arg_NAME}.md")
  if(arg_BASELINE)
    get_filename_component(baseline "${arg_BASELINE}" ABSOLUTE)
    add_custom_target(${arg_NAME}-baseline
      COMMAND ${command} --write-baseline "${baseline}"
      WORKING_DIRECTORY "${CMAKE_CURRENT_SOURCE_DIR}" DEPENDS ${arg_MODULE} VERBATIM)
    list(APPEND reports --baseline "${baseline}")
  endif()
  add_test(NAME ${arg_NAME} COMMAND ${command} ${reports} WORKING_DIRECTORY "${CMAKE_CURRENT_SOURCE_DIR}")
endfunction()
