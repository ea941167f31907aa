# plab_plugin(NAME sources... [LINK libraries...]): one of pLab's own plugins, in build/lib/plab.
#
# What the plugin is made of is a static library plab_NAME beside it, which unit tests link; the plugin's entry, plugin.cpp, is
# not part of it.
include(${CMAKE_CURRENT_LIST_DIR}/plab-plugin.cmake)

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

  plab_add_plugin(${name} TARGET plugin_${name} ${entry} LINK plab_${name})
  set_target_properties(plugin_${name} PROPERTIES LIBRARY_OUTPUT_DIRECTORY ${PLAB_PLUGIN_DIR})
  plab_use_pch(plugin_${name})
  add_dependencies(plugin_${name} plab-manifest)
  set_property(GLOBAL APPEND PROPERTY PLAB_PLUGINS plugin_${name})
endfunction()
