# Libraries, headers, modules and the package for find_package(atrium). Installed headers are the
# libraries' include/ folders verbatim. Programs install themselves.
include(CMakePackageConfigHelpers)
set(ATRIUM_PACKAGE_DIR "${CMAKE_INSTALL_LIBDIR}/cmake/atrium")

get_property(libraries GLOBAL PROPERTY ATRIUM_LIBRARIES)
get_property(modules GLOBAL PROPERTY ATRIUM_MODULES)
get_property(include_dirs GLOBAL PROPERTY ATRIUM_INCLUDE_DIRS)

install(TARGETS ${libraries} EXPORT atrium-targets ARCHIVE DESTINATION "${CMAKE_INSTALL_LIBDIR}")
if(modules)
  install(TARGETS ${modules} LIBRARY DESTINATION "${CMAKE_INSTALL_LIBDIR}/atrium")
endif()
foreach(dir ${include_dirs})
  install(DIRECTORY "${dir}/" DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/atrium")
endforeach()
install(EXPORT atrium-targets NAMESPACE atrium:: DESTINATION "${ATRIUM_PACKAGE_DIR}")

set(ATRIUM_MODULE_DIR "${CMAKE_INSTALL_LIBDIR}/atrium")
configure_package_config_file("${PROJECT_SOURCE_DIR}/cmake/atrium-config.cmake.in"
  "${PROJECT_BINARY_DIR}/atrium-config.cmake"
  INSTALL_DESTINATION "${ATRIUM_PACKAGE_DIR}" PATH_VARS ATRIUM_MODULE_DIR)
write_basic_package_version_file("${PROJECT_BINARY_DIR}/atrium-config-version.cmake"
  COMPATIBILITY SameMinorVersion)
install(FILES "${PROJECT_BINARY_DIR}/atrium-config.cmake"
              "${PROJECT_BINARY_DIR}/atrium-config-version.cmake"
        DESTINATION "${ATRIUM_PACKAGE_DIR}")
