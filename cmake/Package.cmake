# cmake --install: the library, its public headers, and what find_package(isophote) reads.
include(CMakePackageConfigHelpers)
set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/isophote)

install(TARGETS isophote EXPORT isophote)
install(DIRECTORY include/isophote DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
# isophote/features.hpp reads it beside itself.
install(FILES ${PROJECT_SOURCE_DIR}/shaders/shared/features.inc DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/isophote/shared)
install(EXPORT isophote FILE isophoteTargets.cmake NAMESPACE isophote:: DESTINATION ${package_folder})

configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/isophoteConfig.cmake.in ${CMAKE_CURRENT_BINARY_DIR}/isophoteConfig.cmake
  INSTALL_DESTINATION ${package_folder})
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/isophoteConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/isophoteConfig.cmake ${CMAKE_CURRENT_BINARY_DIR}/isophoteConfigVersion.cmake
  DESTINATION ${package_folder})
