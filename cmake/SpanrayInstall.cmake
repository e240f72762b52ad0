# cmake --install: library, public headers, programs, and what find_package(spanray CONFIG) and pkg-config need.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

install(TARGETS spanray EXPORT spanrayTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/engine/include/spanray DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
if(TARGET spanray_program)
  install(TARGETS spanray_program spanray_make_assets RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endif()

set(spanray_package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/spanray)
install(EXPORT spanrayTargets NAMESPACE spanray:: DESTINATION ${spanray_package_dir})
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/spanrayConfig.cmake.in ${PROJECT_BINARY_DIR}/spanrayConfig.cmake
  INSTALL_DESTINATION ${spanray_package_dir} PATH_VARS CMAKE_INSTALL_DATADIR)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/spanrayConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/spanrayConfig.cmake ${PROJECT_BINARY_DIR}/spanrayConfigVersion.cmake
  DESTINATION ${spanray_package_dir})

# What spanray_add_formula() compiles: the sources that read the catalog, and all that they include.
set(spanray_formula_dir ${CMAKE_INSTALL_DATADIR}/spanray)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/engine DESTINATION ${spanray_formula_dir}
  FILES_MATCHING PATTERN "*.h" PATTERN "*.inl" PATTERN "catalog.cmake" PATTERN "include" EXCLUDE)
spanray_formula_sources(spanray_sources)
foreach(source ${spanray_sources})
  get_filename_component(folder ${source} DIRECTORY)
  install(FILES ${PROJECT_SOURCE_DIR}/engine/${source} DESTINATION ${spanray_formula_dir}/engine/${folder})
endforeach()
install(FILES ${CMAKE_CURRENT_LIST_DIR}/SpanrayFlags.cmake ${CMAKE_CURRENT_LIST_DIR}/SpanrayFormulas.cmake DESTINATION ${spanray_formula_dir}/cmake)

set(spanray_pc_requires "libpng libjpeg libhwy")
if(NOT SPANRAY_STD_THREADS)
  string(APPEND spanray_pc_requires " tbb")
endif()
# Relative to the file itself: `cmake --install --prefix` may choose another place than the configuration.
file(RELATIVE_PATH spanray_pc_to_prefix "/${CMAKE_INSTALL_LIBDIR}/pkgconfig" "/")
configure_file(${CMAKE_CURRENT_LIST_DIR}/spanray.pc.in ${PROJECT_BINARY_DIR}/spanray.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/spanray.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
