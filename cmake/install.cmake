# Each component (core, nbody, fluid, render, any, measure, io, tool) has its own install component and export file, so that
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

# hedgerow_pkg_config(COMPONENT COMPONENTS PACKAGES...): its pkg-config file, hedgerow-COMPONENT.pc, with what its
# headers need of hedgerow's own and the packages that it is made with. Users of a static library link those too.
file(RELATIVE_PATH hedgerow_prefix_from_pc /prefix/${CMAKE_INSTALL_LIBDIR}/pkgconfig /prefix)
function(hedgerow_pkg_config component requires)
  set(requires_private ${ARGN})
  if(NOT BUILD_SHARED_LIBS)
    list(APPEND requires ${ARGN})
    set(requires_private)
  endif()
  list(JOIN requires " " requires)
  list(JOIN requires_private " " requires_private)
  configure_file(cmake/hedgerow.pc.in hedgerow-${component}.pc @ONLY)
  install(FILES ${PROJECT_BINARY_DIR}/hedgerow-${component}.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig
          COMPONENT ${component})
endfunction()

hedgerow_install(core)
set(core_packages)
if(HEDGEROW_TBB)
  list(APPEND core_packages tbb)
endif()
if(HEDGEROW_QHULL)
  list(APPEND core_packages qhull_r)
endif()
hedgerow_pkg_config(core "" ${core_packages})
install(DIRECTORY include/hedgerow DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT core
        FILES_MATCHING PATTERN "*.h"
        PATTERN include/hedgerow/measure EXCLUDE
        PATTERN include/hedgerow/io EXCLUDE
        PATTERN include/hedgerow/scenes EXCLUDE)
foreach(component nbody render)
  hedgerow_install(${component})
  hedgerow_pkg_config(${component} hedgerow-core)
endforeach()
hedgerow_install(fluid)
hedgerow_pkg_config(fluid hedgerow-nbody)
# Its headers need these of the components io and scenes, which use no library.
foreach(header io/image.h io/exr.h scenes/random.h)
  get_filename_component(folder ${header} DIRECTORY)
  install(FILES include/hedgerow/${header} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/hedgerow/${folder} COMPONENT render)
endforeach()
hedgerow_install(any)
hedgerow_pkg_config(any hedgerow-core)
hedgerow_install(measure)
hedgerow_pkg_config(measure "hedgerow-any;hedgerow-render")
hedgerow_install_headers(measure measure)
if(HEDGEROW_IO)
  hedgerow_install(io)
  set(io_packages zlib libpng libturbojpeg)
  if(HEDGEROW_EXR)
    list(APPEND io_packages OpenEXR)
  endif()
  if(HEDGEROW_HDF5)
    list(APPEND io_packages hdf5)
  endif()
  if(HEDGEROW_HAS_DRACO)
    list(APPEND io_packages draco)
  endif()
  hedgerow_pkg_config(io hedgerow-core ${io_packages})
  hedgerow_install_headers(io io scenes)
endif()
if(HEDGEROW_TOOL)
  hedgerow_install(tool)
endif()

configure_package_config_file(cmake/hedgerow-config.cmake.in hedgerow-config.cmake
                              INSTALL_DESTINATION ${hedgerow_package_dir})
# Before 1.0 a minor version may break what is built on it.
write_basic_package_version_file(hedgerow-config-version.cmake COMPATIBILITY SameMinorVersion)
foreach(component core nbody fluid render any measure io tool)
  # With every component: each may be the only one that is installed.
  install(FILES ${PROJECT_BINARY_DIR}/hedgerow-config.cmake ${PROJECT_BINARY_DIR}/hedgerow-config-version.cmake
          DESTINATION ${hedgerow_package_dir} COMPONENT ${component})
  install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT ${component})
endforeach()

# The documents keep the places that their links name: README.md beside docs/ and examples/.
install(FILES README.md ARCHITECTURE.md CHANGELOG.md CONTRIBUTING.md DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT core)
install(DIRECTORY docs examples DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT core PATTERN CMakeLists.txt EXCLUDE)
