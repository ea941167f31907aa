# plab_add_plugin(NAME sources... [LINK libraries...] [TARGET target]): the plugin NAME.so, and beside it NAME.manifest, the list of types
# by which plabd finds it without loading it. A plugin sees the SDK and its own third party, nothing else of pLab. It lies in
# LIBRARY_OUTPUT_DIRECTORY of its target, the build folder by default; PLAB_PLUGIN_PATH names that folder to plabd.
# pLab's own plugins are made by this, and the installed package has it.
function(plab_add_plugin name)
  cmake_parse_arguments(arg "" "TARGET" "LINK" ${ARGN})
  set(target ${name})
  if(arg_TARGET)
    set(target ${arg_TARGET})
  endif()
  add_library(${target} MODULE ${arg_UNPARSED_ARGUMENTS})
  target_link_libraries(${target} PRIVATE plab::sdk ${arg_LINK})
  target_include_directories(${target} PRIVATE ${CMAKE_CURRENT_SOURCE_DIR})
  # Two plugins in one process must not take one another's functions: only the entry is seen from outside.
  set_target_properties(${target} PROPERTIES PREFIX "" OUTPUT_NAME ${name} CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
  add_custom_command(TARGET ${target} POST_BUILD
    COMMAND plab::manifest $<TARGET_FILE:${target}> $<TARGET_FILE_DIR:${target}>/${name}.manifest VERBATIM)
  # A manifest of another version is refused, so a new plab-manifest writes all of them again.
  set_property(TARGET ${target} APPEND PROPERTY LINK_DEPENDS $<TARGET_FILE:plab::manifest>)
endfunction()
