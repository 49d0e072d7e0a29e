# `cmake --install` gives a package that find_package(vantage COMPONENTS core registration session simulation) finds.
# Only `core` is always there; each component brings the packages that vantage_require() noted for it and no others.
include(CMakePackageConfigHelpers)
set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/vantage)

get_property(vantage_libraries GLOBAL PROPERTY VANTAGE_LIBRARIES)
foreach(library IN LISTS vantage_libraries)
  get_target_property(component ${library} EXPORT_NAME)
  get_target_property(folders ${library} VANTAGE_FOLDERS)
  install(TARGETS ${library} EXPORT vantage-${component} ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT dev)
  install(EXPORT vantage-${component} NAMESPACE vantage:: DESTINATION ${package_folder} COMPONENT dev)
  foreach(folder IN LISTS folders)
    install(DIRECTORY src/vantage/${folder} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/vantage COMPONENT dev
            FILES_MATCHING PATTERN "*.hpp")
  endforeach()
  get_property(required GLOBAL PROPERTY VANTAGE_REQUIRES_${component})
  file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/package/vantage-${component}-dependencies.cmake CONTENT "${required}" @ONLY)
  install(FILES ${PROJECT_BINARY_DIR}/package/vantage-${component}-dependencies.cmake DESTINATION ${package_folder}
    COMPONENT dev)
endforeach()

configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/vantageConfig.cmake.in
  ${PROJECT_BINARY_DIR}/package/vantageConfig.cmake INSTALL_DESTINATION ${package_folder})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/package/vantageConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/package/vantageConfig.cmake ${PROJECT_BINARY_DIR}/package/vantageConfigVersion.cmake
  DESTINATION ${package_folder} COMPONENT dev)
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT license)
if(VANTAGE_APPS)
  install(TARGETS vantage COMPONENT program)
endif()
if(VANTAGE_APPS AND PROJECT_IS_TOP_LEVEL)
  include(VantagePackages)
endif()
