# Installs the library for find_package(deltasplat).
install(TARGETS deltasplat EXPORT deltasplat-targets
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(DIRECTORY include/deltasplat DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
set(DELTASPLAT_CMAKE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/deltasplat)
install(EXPORT deltasplat-targets NAMESPACE deltasplat:: DESTINATION ${DELTASPLAT_CMAKE_DIR})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/deltasplat-config-version.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/deltasplat-config-version.cmake
              cmake/deltasplat-config.cmake cmake/dependencies.cmake
        DESTINATION ${DELTASPLAT_CMAKE_DIR})
# What there is to read, where the links of README.md lead.
if(PROJECT_IS_TOP_LEVEL)
    install(FILES README.md LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
    install(DIRECTORY docs examples DESTINATION ${CMAKE_INSTALL_DOCDIR} USE_SOURCE_PERMISSIONS)
endif()
