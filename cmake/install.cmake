# Each component (core, any, io, tool) has its own install component and export file, so that
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

# The headers in these folders go with that component, the rest with core.
function(hedgerow_install_headers component)
  list(TRANSFORM ARGN PREPEND ${PROJECT_SOURCE_DIR}/include/hedgerow/ OUTPUT_VARIABLE folders)
  install(DIRECTORY ${folders} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/hedgerow COMPONENT ${component}
          FILES_MATCHING PATTERN "*.h")
endfunction()

hedgerow_install(core)
install(DIRECTORY include/hedgerow DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT core
        FILES_MATCHING PATTERN "*.h"
        PATTERN include/hedgerow/compare EXCLUDE PATTERN include/hedgerow/io EXCLUDE
        PATTERN include/hedgerow/scenes EXCLUDE)
hedgerow_install(any)
hedgerow_install_headers(any compare)
if(HEDGEROW_IO)
  hedgerow_install(io)
  hedgerow_install_headers(io io scenes)
endif()
if(HEDGEROW_TOOL)
  hedgerow_install(tool)
endif()

configure_package_config_file(cmake/hedgerow-config.cmake.in hedgerow-config.cmake
                              INSTALL_DESTINATION ${hedgerow_package_dir})
# Before 1.0 a minor version may break what is built on it.
write_basic_package_version_file(hedgerow-config-version.cmake COMPATIBILITY SameMinorVersion)
foreach(component core any io tool)
  # With every component: each may be the only one that is installed.
  install(FILES ${PROJECT_BINARY_DIR}/hedgerow-config.cmake ${PROJECT_BINARY_DIR}/hedgerow-config-version.cmake
          DESTINATION ${hedgerow_package_dir} COMPONENT ${component})
  install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT ${component})
endforeach()
