# find_package(deltasplat) gives the target deltasplat::deltasplat.
include("${CMAKE_CURRENT_LIST_DIR}/dependencies.cmake")
include("${CMAKE_CURRENT_LIST_DIR}/deltasplat-targets.cmake")
