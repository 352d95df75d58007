# Everything comes from Debian packages; scripts/install_dependencies.sh installs them.
# The includer defines deltasplat_find: find_package or, in the installed package, find_dependency.
list(APPEND CMAKE_MODULE_PATH "${CMAKE_CURRENT_LIST_DIR}")

# OpenVDB ships its find module outside of CMake's own search path.
file(GLOB DELTASPLAT_OPENVDB_MODULES /usr/lib/*/cmake/OpenVDB /usr/lib/cmake/OpenVDB
     /usr/local/lib*/cmake/OpenVDB)
list(APPEND CMAKE_MODULE_PATH ${DELTASPLAT_OPENVDB_MODULES})

# The module sets BUILD_SHARED_LIBS for its own ends; ours is the caller's to choose.
set(DELTASPLAT_BUILD_SHARED_LIBS ${BUILD_SHARED_LIBS})
deltasplat_find(OpenVDB 10)
set(BUILD_SHARED_LIBS ${DELTASPLAT_BUILD_SHARED_LIBS})
deltasplat_find(TBB)
deltasplat_find(OpenEXR 3.1.3 CONFIG)
deltasplat_find(OpenImageIO)
deltasplat_find(glm)
deltasplat_find(hwy)
deltasplat_find(ZLIB)
deltasplat_find(Blosc)
deltasplat_find(nlohmann_json)
if(NOT TARGET OpenVDB::openvdb OR NOT TARGET OpenImageIO::OpenImageIO)
    message(FATAL_ERROR "OpenVDB or OpenImageIO not found; run scripts/install_dependencies.sh")
endif()

# Debian's OpenImageIO names a folder of OpenCV headers that only its optional parts need.
get_target_property(DELTASPLAT_OIIO_INCLUDES OpenImageIO::OpenImageIO INTERFACE_INCLUDE_DIRECTORIES)
foreach(folder ${DELTASPLAT_OIIO_INCLUDES})
    if(NOT EXISTS ${folder})
        list(REMOVE_ITEM DELTASPLAT_OIIO_INCLUDES ${folder})
    endif()
endforeach()
set_target_properties(OpenImageIO::OpenImageIO PROPERTIES
    INTERFACE_INCLUDE_DIRECTORIES "${DELTASPLAT_OIIO_INCLUDES}")
