# The package: `cmake --install build/release --component sdk --prefix WHERE`, then find_package(etendue COMPONENTS core photometry eval).
# Of the components, those that need no picture library; render, compare and report are linked within this build alone so far.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/etendue)

foreach(component core photometry eval)
  set_target_properties(etendue_${component} PROPERTIES EXPORT_NAME ${component})
  install(TARGETS etendue_${component} EXPORT etendue-${component} COMPONENT sdk)
  install(EXPORT etendue-${component} NAMESPACE etendue:: DESTINATION ${package_folder} COMPONENT sdk)
endforeach()
foreach(header bytes result units vec colour colour_space srgb spectrum light_presets camera batch pixel metering false_colour light hdri light_units arithmetic convert unit_names quantity_text formulas material image scene io dialect photometry intensity_web photometric_comparison photometric_quantities photometric_transform web_sampler eval)
  install(FILES ${PROJECT_SOURCE_DIR}/sdk/include/etendue/${header}.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/etendue COMPONENT sdk)
endforeach()
write_basic_package_version_file(${PROJECT_BINARY_DIR}/etendue-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_LIST_DIR}/etendue-config.cmake ${PROJECT_BINARY_DIR}/etendue-config-version.cmake DESTINATION ${package_folder}
        COMPONENT sdk)
