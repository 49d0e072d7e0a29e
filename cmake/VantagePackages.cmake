# Debian packages by CPack: `cmake --build build/release --target package` writes them into build/release/packages.
# vantage: program, page, man pages, completions, service; libvantage-dev: headers, libraries, CMake package;
# python3-vantage: the Python module. Dependencies on shared libraries come from dpkg-shlibdeps.

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME vantage)
set(CPACK_PACKAGE_VENDOR "Vantage")
set(CPACK_PACKAGE_CONTACT "Vantage developers <vantage@users.noreply.github.com>")
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_DIRECTORY ${PROJECT_BINARY_DIR}/packages)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING ONE_PER_GROUP)
set(CPACK_COMPONENTS_ALL program dev)
if(TARGET vantage_python)
  list(APPEND CPACK_COMPONENTS_ALL python)
endif()
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)

set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME vantage)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PROGRAM_DESCRIPTION "Vantage plans where a depth sensor should look next, so that an unknown object
is scanned completely with few views. It takes depth images or clouds with
poses, registers them, prints the next view with its reason, keeps sessions
over hours and restarts, serves them over HTTP, and shows everything in a
browser.")

set(CPACK_DEBIAN_DEV_PACKAGE_NAME libvantage-dev)
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEV_DESCRIPTION "Headers, static libraries and the CMake package of Vantage:
find_package(vantage COMPONENTS session) and target_link_libraries(robot
vantage::session).")
# A static library needs what its headers and its CMake package ask for.
file(STRINGS ${PROJECT_SOURCE_DIR}/cmake/debian-packages.txt vantage_package_lines)
set(vantage_dev_packages)
set(vantage_section)
foreach(line IN LISTS vantage_package_lines)
  if(line MATCHES "^# ([a-z]+)$")
    set(vantage_section ${CMAKE_MATCH_1})
  elseif(vantage_section STREQUAL build AND line MATCHES "^(lib[a-z0-9.+-]+-dev|nlohmann-json3-dev)")
    list(APPEND vantage_dev_packages ${CMAKE_MATCH_1})
  endif()
endforeach()
list(REMOVE_ITEM vantage_dev_packages libcli11-dev)
list(JOIN vantage_dev_packages ", " CPACK_DEBIAN_DEV_PACKAGE_DEPENDS)

set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-vantage)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "python3 (>= ${Python_VERSION_MAJOR}.${Python_VERSION_MINOR}), python3-numpy")
# Python keeps bytecode beside the module, which has to go with it.
set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA ${PROJECT_SOURCE_DIR}/packaging/python3-vantage/postinst
  ${PROJECT_SOURCE_DIR}/packaging/python3-vantage/prerm)
set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_STRICT_PERMISSION TRUE)
math(EXPR vantage_next_python "${Python_VERSION_MINOR} + 1")
string(APPEND CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS ", python3 (<< ${Python_VERSION_MAJOR}.${vantage_next_python})")
set(CPACK_DEBIAN_PYTHON_DESCRIPTION "The Vantage library with numpy arrays in and out: planning, registration,
simulation and sessions.")

# What Debian's policy wants in /usr/share/doc/PACKAGE, for each of the packages.
set(vantage_package_texts ${PROJECT_BINARY_DIR}/package-texts)
file(READ ${PROJECT_SOURCE_DIR}/LICENSE vantage_license)
file(CONFIGURE OUTPUT ${vantage_package_texts}/copyright @ONLY CONTENT
"Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/
Upstream-Name: vantage

@vantage_license@")
file(CONFIGURE OUTPUT ${vantage_package_texts}/changelog.Debian @ONLY CONTENT
"vantage (@PROJECT_VERSION@-1) stable; urgency=medium

  * Packages of the project's own build; CHANGELOG.md says what is new.

 -- Vantage developers <vantage@users.noreply.github.com>  @VANTAGE_RELEASE_DATE@
")
find_program(VANTAGE_GZIP gzip REQUIRED)
execute_process(COMMAND ${VANTAGE_GZIP} -9nkf ${vantage_package_texts}/changelog.Debian COMMAND_ERROR_IS_FATAL ANY)
foreach(component_and_package program/vantage dev/libvantage-dev python/python3-vantage)
  string(REPLACE "/" ";" parts ${component_and_package})
  list(GET parts 0 component)
  list(GET parts 1 package)
  install(FILES ${vantage_package_texts}/copyright ${vantage_package_texts}/changelog.Debian.gz
    DESTINATION ${CMAKE_INSTALL_DATAROOTDIR}/doc/${package} COMPONENT ${component} EXCLUDE_FROM_ALL)
endforeach()

# Man pages and completions, written by the program itself.
set(vantage_manual ${PROJECT_BINARY_DIR}/manual)
add_custom_command(OUTPUT ${vantage_manual}/done
  COMMAND ${CMAKE_COMMAND} -E rm -rf ${vantage_manual}
  COMMAND vantage write-manual ${vantage_manual}
  COMMAND sh -c "cd '${vantage_manual}' && ${VANTAGE_GZIP} -9n *.1 && touch done"
  DEPENDS vantage VERBATIM)
add_custom_target(vantage_manual ALL DEPENDS ${vantage_manual}/done)
install(DIRECTORY ${vantage_manual}/ DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT program
  FILES_MATCHING PATTERN "*.1.gz")
install(FILES ${vantage_manual}/vantage.bash DESTINATION ${CMAKE_INSTALL_DATAROOTDIR}/bash-completion/completions
  RENAME vantage COMPONENT program)
install(FILES ${vantage_manual}/_vantage DESTINATION ${CMAKE_INSTALL_DATAROOTDIR}/zsh/vendor-completions
  COMPONENT program)
install(FILES ${PROJECT_SOURCE_DIR}/packaging/vantage-serve@.service DESTINATION lib/systemd/system COMPONENT program)

include(CPack)
