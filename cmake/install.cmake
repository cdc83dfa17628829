# Each component (core, io, tool) has its own install component and export file, so that
# `cmake --install BUILD --component core` alone is a working package.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
set(hedgerow_package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/hedgerow)

function(hedgerow_install component)
  set_target_properties(hedgerow_${component} PROPERTIES EXPORT_NAME ${component})
  install(TARGETS hedgerow_${component} EXPORT hedgerow-${component}-targets
          RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT ${component}
          LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT ${component}
          ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT ${component}
          INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
  install(EXPORT hedgerow-${component}-targets NAMESPACE hedgerow:: DESTINATION ${hedgerow_package_dir}
          COMPONENT ${component})
endfunction()

set(io_headers io scenes)
list(TRANSFORM io_headers PREPEND ${PROJECT_SOURCE_DIR}/include/hedgerow/ OUTPUT_VARIABLE io_header_dirs)

hedgerow_install(core)
install(DIRECTORY include/hedgerow DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT core
        FILES_MATCHING PATTERN "*.h"
        PATTERN include/hedgerow/io EXCLUDE PATTERN include/hedgerow/scenes EXCLUDE)
if(HEDGEROW_IO)
  hedgerow_install(io)
  install(DIRECTORY ${io_header_dirs} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/hedgerow COMPONENT io
          FILES_MATCHING PATTERN "*.h")
endif()
if(HEDGEROW_TOOL)
  hedgerow_install(tool)
endif()

configure_package_config_file(cmake/hedgerow-config.cmake.in hedgerow-config.cmake
                              INSTALL_DESTINATION ${hedgerow_package_dir})
# Before 1.0 a minor version may break what is built on it.
write_basic_package_version_file(hedgerow-config-version.cmake COMPATIBILITY SameMinorVersion)
foreach(component core io tool)
  # With every component: each may be the only one that is installed.
  install(FILES ${PROJECT_BINARY_DIR}/hedgerow-config.cmake ${PROJECT_BINARY_DIR}/hedgerow-config-version.cmake
          DESTINATION ${hedgerow_package_dir} COMPONENT ${component})
  install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT ${component})
endforeach()
