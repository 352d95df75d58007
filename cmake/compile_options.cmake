# ccache is used where it is found, unless CMAKE_CXX_COMPILER_LAUNCHER is given, be it empty.
if(PROJECT_IS_TOP_LEVEL AND NOT DEFINED CMAKE_CXX_COMPILER_LAUNCHER)
    find_program(DELTASPLAT_CCACHE ccache)
    if(DELTASPLAT_CCACHE)
        set(CMAKE_CXX_COMPILER_LAUNCHER ${DELTASPLAT_CCACHE})
    endif()
endif()

# Applies the house's compiler settings to one target of ours.
function(deltasplat_compile_options target)
    # Pixels must not depend on whether a compiler fuses a multiply and an add.
    target_compile_options(${target} PRIVATE -ffp-contract=off -Wall -Wextra)
    # GCC 12 sees overlapping copies in every "text" + std::string (its bug 105651).
    if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
        target_compile_options(${target} PRIVATE -Wno-restrict)
    endif()
    if(DELTASPLAT_WERROR)
        target_compile_options(${target} PRIVATE -Werror)
    endif()
    set_target_properties(${target} PROPERTIES CXX_EXTENSIONS OFF)
endfunction()

# Compiles a release's sources of a target with -O1, but for its kernels: what has no loop over
# voxels or pixels runs as fast, and takes two thirds of the time to compile (docs/decisions.md).
function(deltasplat_quick_to_compile target)
    get_target_property(sources ${target} SOURCES)
    list(FILTER sources EXCLUDE REGEX "_kernels\\.cpp$|\\.S$|TARGET_OBJECTS")
    set_property(SOURCE ${sources} TARGET_DIRECTORY ${target}
        APPEND PROPERTY COMPILE_OPTIONS $<$<CONFIG:Release>:-O1>)
endfunction()
