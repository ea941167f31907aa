# plab_plugin(NAME sources... [LINK libraries...]): one of pLab's own plugins, in build/lib/plab.
include(${CMAKE_CURRENT_LIST_DIR}/plab-plugin.cmake)

function(plab_plugin name)
  plab_add_plugin(${name} TARGET plugin_${name} ${ARGN})
  set_target_properties(plugin_${name} PROPERTIES LIBRARY_OUTPUT_DIRECTORY ${PLAB_PLUGIN_DIR})
  plab_use_pch(plugin_${name})
  add_dependencies(plugin_${name} plab-manifest)
  set_property(GLOBAL APPEND PROPERTY PLAB_PLUGINS plugin_${name})
endfunction()
