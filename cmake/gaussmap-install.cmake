# SPDX-License-Identifier: BSD-3-Clause
# Rules for cmake --install, and the package that find_package(gaussmap) finds: one file of targets per component.
include(CMakePackageConfigHelpers)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/gaussmap)
install(DIRECTORY include/gaussmap DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN "*.h" PATTERN "pcl" EXCLUDE)
set(components core io)
if(GAUSSMAP_BUILD_PCL)
  list(APPEND components pcl)
  install(DIRECTORY include/gaussmap/pcl DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/gaussmap)
endif()
foreach(component ${components})
  install(TARGETS gaussmap_${component} EXPORT gaussmap-${component}-targets
          ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}
          RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
  install(EXPORT gaussmap-${component}-targets NAMESPACE gaussmap:: DESTINATION ${package_dir})
endforeach()
if(GAUSSMAP_BUILD_APPS)
  install(TARGETS gaussmap_app RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
  if(GAUSSMAP_BUILD_VIEWER)
    install(TARGETS gaussmap_view RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})  # `gaussmap view` expects it in its folder
  endif()
  if(NOT CMAKE_CROSSCOMPILING)
    install(DIRECTORY ${PROJECT_BINARY_DIR}/apps/man/ DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
    set(written ${PROJECT_BINARY_DIR}/apps/completions)
    install(FILES ${written}/gaussmap DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)
    install(FILES ${written}/_gaussmap DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions)
    install(FILES ${written}/gaussmap.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d)
  endif()
endif()
install(FILES LICENSE README.md CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR})

configure_package_config_file(cmake/gaussmap-config.cmake.in ${PROJECT_BINARY_DIR}/gaussmap-config.cmake
                              INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/gaussmap-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/gaussmap-config.cmake ${PROJECT_BINARY_DIR}/gaussmap-config-version.cmake
        DESTINATION ${package_dir})
