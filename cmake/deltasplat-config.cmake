# find_package(deltasplat) gives the target deltasplat::deltasplat.
include(CMakeFindDependencyMacro)
set(deltasplat_FOUND TRUE)
# What the search sets (module path, BUILD_SHARED_LIBS) is not for the caller to see.
block(PROPAGATE deltasplat_FOUND deltasplat_NOT_FOUND_MESSAGE)
    macro(deltasplat_find)
        find_dependency(${ARGV})
    endmacro()
    include("${CMAKE_CURRENT_LIST_DIR}/dependencies.cmake")
endblock()
# A dependency that is missing has left its message; the caller said how bad that is.
if(deltasplat_FOUND)
    include("${CMAKE_CURRENT_LIST_DIR}/deltasplat-targets.cmake")
endif()
