# plab_plugin(NAME sources... [LINK libraries...]): a plugin in build/lib/plab with its manifest, the list of types by
# which it is found without loading it. A plugin sees the SDK and its own third party, nothing else of pLab.
#
# What the plugin is made of is a static library plab_NAME beside it, which unit tests link; the plugin's entry, plugin.cpp, is
# not part of it.
function(plab_plugin name)
  cmake_parse_arguments(arg "" "" "LINK" ${ARGN})
  set(code ${arg_UNPARSED_ARGUMENTS})
  set(entry ${code})
  list(FILTER code EXCLUDE REGEX "/plugin\\.cpp$")
  list(FILTER entry INCLUDE REGEX "/plugin\\.cpp$")
  add_library(plab_${name} STATIC ${code})
  target_link_libraries(plab_${name} PUBLIC plab_sdk ${arg_LINK})
  target_include_directories(plab_${name} PUBLIC ${CMAKE_CURRENT_SOURCE_DIR})
  plab_use_pch(plab_${name})

  add_library(plugin_${name} MODULE ${entry})
  target_link_libraries(plugin_${name} PRIVATE plab_${name})
  set_target_properties(plugin_${name} PROPERTIES PREFIX "" OUTPUT_NAME ${name} LIBRARY_OUTPUT_DIRECTORY ${PLAB_PLUGIN_DIR})
  add_custom_command(TARGET plugin_${name} POST_BUILD
    COMMAND plab-manifest $<TARGET_FILE:plugin_${name}> ${PLAB_PLUGIN_DIR}/${name}.manifest VERBATIM)
  plab_use_pch(plugin_${name})
  add_dependencies(plugin_${name} plab-manifest)
  # A manifest of another version is refused, so a new plab-manifest writes all of them again.
  set_property(TARGET plugin_${name} APPEND PROPERTY LINK_DEPENDS $<TARGET_FILE:plab-manifest>)
  set_property(GLOBAL APPEND PROPERTY PLAB_PLUGINS plugin_${name})
endfunction()
