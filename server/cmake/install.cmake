# What `cmake --install BUILD --prefix PREFIX` puts where, in two components: "server" (plabd, its clients, plugins and
# scenes) and "viewer" (what needs OSMesa besides). plabd finds its plugins in ../lib/plab as seen from its own folder, so
# PREFIX may be moved. Included last: it needs all targets.

# Plugins that need more than the packages of group run.
set(plugins_of_viewer plugin_cameras)

# The plugin and its manifest, without which it is not found.
function(plab_install_plugin plugin component)
  install(TARGETS ${plugin} LIBRARY DESTINATION lib/plab COMPONENT ${component})
  get_target_property(name ${plugin} OUTPUT_NAME)
  install(FILES ${PLAB_PLUGIN_DIR}/${name}.manifest DESTINATION lib/plab COMPONENT ${component})
endfunction()

get_property(plugins GLOBAL PROPERTY PLAB_PLUGINS)
foreach(plugin ${plugins})
  if(plugin IN_LIST plugins_of_viewer)
    plab_install_plugin(${plugin} viewer)
  else()
    plab_install_plugin(${plugin} server)
  endif()
endforeach()

install(TARGETS plabd plab-bus plabctl plab-log RUNTIME DESTINATION bin COMPONENT server)
# No plugins for scenes: plabd loads them by their names, and starts the plab-bus beside it, when it joins the bus or records.
install(TARGETS plab_bus plab_record LIBRARY DESTINATION lib/plab COMPONENT server)
install(DIRECTORY scenes DESTINATION share/plab COMPONENT server PATTERN "*.md" EXCLUDE)
install(TARGETS plab-view RUNTIME DESTINATION bin COMPONENT viewer)
install(TARGETS plab-study RUNTIME DESTINATION bin COMPONENT study)
