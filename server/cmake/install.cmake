# What `cmake --install BUILD --prefix PREFIX` puts where, in components: "server" (plabd, its clients, plugins and scenes), "viewer"
# (what needs OSMesa besides), "web" (plab-web and its page, plab-foxglove), "study" (plab-study), "python" (the Python package), "doc" (these
# documents) and "sdk" (what plugins and clients are built with
# elsewhere). plabd finds its plugins in ../lib/plab as seen from its own folder, and the CMake package and pkg-config's files look from
# theirs, so PREFIX may be moved. The folders are the same under every PREFIX for that reason, /usr among them. Included last: it needs
# all targets.
include(CMakePackageConfigHelpers)

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

install(TARGETS plabd plab-bus plab-bus-ros plabctl plab-log RUNTIME DESTINATION bin COMPONENT server)
# No plugins for scenes: plabd loads them by their names, and starts the plab-bus beside it, when it joins the bus or records,
# or when a scene has meshes in files.
install(TARGETS plab_bus plab_record plab_meshes LIBRARY DESTINATION lib/plab COMPONENT server)
install(DIRECTORY scenes DESTINATION share/plab COMPONENT server PATTERN "*.md" EXCLUDE PATTERN exact EXCLUDE)
install(TARGETS plab-view RUNTIME DESTINATION bin COMPONENT viewer)
install(TARGETS plab-web plab-foxglove RUNTIME DESTINATION bin COMPONENT web)
# Not there without npm: plab-web then says so.
install(DIRECTORY ${PROJECT_BINARY_DIR}/share/plab/web DESTINATION share/plab COMPONENT web)
install(TARGETS plab-study RUNTIME DESTINATION bin COMPONENT study)
# Where Debian's Python looks, if PREFIX is /usr; elsewhere PYTHONPATH names it. The package looks for the programs from there.
set(PLAB_PYTHON_DIR lib/python3/dist-packages/plab)
install(DIRECTORY clients/python/plab/ DESTINATION ${PLAB_PYTHON_DIR} COMPONENT python FILES_MATCHING PATTERN "*.py" PATTERN "py.typed"
  PATTERN __pycache__ EXCLUDE)
install(TARGETS plab_python LIBRARY DESTINATION ${PLAB_PYTHON_DIR} COMPONENT python)
install(DIRECTORY clients/python/examples DESTINATION share/plab/python COMPONENT python FILES_MATCHING PATTERN "*.py")
install(DIRECTORY server/docs/ DESTINATION share/doc/plab COMPONENT doc FILES_MATCHING PATTERN "*.md" PATTERN "*.png")

# The SDK: headers, the libraries of clients, the wire's IDL, and what CMake and pkg-config ask for.
set(PLAB_PACKAGE_DIR lib/cmake/plab)
install(DIRECTORY server/base/plab server/sdk/plab DESTINATION include COMPONENT sdk FILES_MATCHING PATTERN "*.h")
install(DIRECTORY clients/link DESTINATION include/plab-link COMPONENT sdk FILES_MATCHING PATTERN "*.h" PATTERN "json.h" EXCLUDE)
file(GLOB wire_headers CONFIGURE_DEPENDS idl/*.h)
install(FILES ${wire_headers} DESTINATION include/plab-link/idl COMPONENT sdk)
install(DIRECTORY idl/values DESTINATION include/plab-link/idl COMPONENT sdk FILES_MATCHING PATTERN "*.h")
# idlc writes the folders of this build into its header, and makes the guard out of them.
set(PLAB_GENERATED_HEADER ${PROJECT_BINARY_DIR}/idl/plab.h)
configure_file(server/cmake/install_header.cmake.in ${PROJECT_BINARY_DIR}/package/install_header.cmake @ONLY)
install(SCRIPT ${PROJECT_BINARY_DIR}/package/install_header.cmake COMPONENT sdk)
install(FILES idl/plab.idl DESTINATION share/plab/idl COMPONENT sdk)
install(TARGETS plab-manifest EXPORT plab-sdk RUNTIME DESTINATION bin COMPONENT sdk)
install(TARGETS plab_determinism plab_base plab_sdk EXPORT plab-sdk COMPONENT sdk)
install(TARGETS plab_values plab_idl_c plab_wire_names plab_wire plab_link EXPORT plab-link ARCHIVE DESTINATION lib COMPONENT sdk)
# --strip is for programs; of archives the debug information is 9 parts of 10, and names sources that are not there.
foreach(archive plab_idl_c plab_wire_names plab_wire plab_link)
  install(CODE "execute_process(COMMAND \"${CMAKE_STRIP}\" --strip-debug \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/lib/lib${archive}.a\" COMMAND_ERROR_IS_FATAL ANY)"
    COMPONENT sdk)
endforeach()
# Two sets: authors of plugins need no Cyclone DDS.
foreach(set plab-sdk plab-link)
  install(EXPORT ${set} NAMESPACE plab:: DESTINATION ${PLAB_PACKAGE_DIR} FILE ${set}-targets.cmake COMPONENT sdk)
endforeach()
configure_package_config_file(server/cmake/plab-config.cmake.in ${PROJECT_BINARY_DIR}/package/plab-config.cmake
  INSTALL_DESTINATION ${PLAB_PACKAGE_DIR} NO_CHECK_REQUIRED_COMPONENTS_MACRO)
# Before 1.0 any minor version may break plugins and clients.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/package/plab-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/package/plab-config.cmake ${PROJECT_BINARY_DIR}/package/plab-config-version.cmake
  server/cmake/plab-plugin.cmake DESTINATION ${PLAB_PACKAGE_DIR} COMPONENT sdk)
get_target_property(flags plab_determinism INTERFACE_COMPILE_OPTIONS)
list(JOIN flags " " PLAB_DETERMINISM)
foreach(name plab-sdk plab-link)
  configure_file(server/cmake/${name}.pc.in ${PROJECT_BINARY_DIR}/package/${name}.pc @ONLY)
  install(FILES ${PROJECT_BINARY_DIR}/package/${name}.pc DESTINATION lib/pkgconfig COMPONENT sdk)
endforeach()
# Its checks are those of the tests; without PLAB_TESTS and PLAB_CONFORMANCE it is not there.
if(TARGET plab-conformance)
  install(TARGETS plab-conformance EXPORT plab-sdk RUNTIME DESTINATION bin COMPONENT sdk)
  install(DIRECTORY tests/conformance/scenes/ DESTINATION share/plab/conformance COMPONENT sdk)
endif()

# Man pages and completion: each program writes its own, out of what its parser understands.
set(shells bash zsh fish)
set(folder_bash share/bash-completion/completions)
set(folder_zsh share/zsh/vendor-completions)
set(folder_fish share/fish/vendor_completions.d)
function(plab_install_help program component)
  set(folder ${PROJECT_BINARY_DIR}/help)
  set(page ${folder}/${program}.1)
  set(made ${page})
  set(commands COMMAND ${program} --print man > ${page})
  set(name_bash ${program})
  set(name_zsh _${program})
  set(name_fish ${program}.fish)
  foreach(shell ${shells})
    set(file ${folder}/${shell}/${name_${shell}})
    file(MAKE_DIRECTORY ${folder}/${shell})
    list(APPEND made ${file})
    list(APPEND commands COMMAND ${program} --print ${shell} > ${file})
    install(FILES ${file} DESTINATION ${folder_${shell}} COMPONENT ${component})
  endforeach()
  add_custom_command(OUTPUT ${made} ${commands} DEPENDS ${program} VERBATIM)
  add_custom_target(help_${program} ALL DEPENDS ${made})
  set_property(GLOBAL APPEND PROPERTY PLAB_HELP help_${program})
  install(FILES ${page} DESTINATION share/man/man1 COMPONENT ${component})
endfunction()
foreach(program plabd plab-bus plab-bus-ros plabctl plab-log)
  plab_install_help(${program} server)
endforeach()
plab_install_help(plab-view viewer)
plab_install_help(plab-web web)
plab_install_help(plab-foxglove web)
plab_install_help(plab-study study)
plab_install_help(plab-manifest sdk)
if(TARGET plab-conformance)
  plab_install_help(plab-conformance sdk)
endif()

# Debian wants one in each package.
foreach(component_package "server plab" "viewer plab-view" "web plab-web" "python python3-plab" "sdk plab-dev")
  string(REPLACE " " ";" pair ${component_package})
  list(GET pair 0 component)
  list(GET pair 1 package)
  install(FILES server/cmake/copyright DESTINATION share/doc/${package} COMPONENT ${component})
endforeach()

# All that is installed, and none of the tests.
get_property(help GLOBAL PROPERTY PLAB_HELP)
add_custom_target(plab_installed DEPENDS plab_runtime plab_python_package plab-study plab-manifest ${help})
if(TARGET plab-conformance)
  add_dependencies(plab_installed plab-conformance)
endif()
