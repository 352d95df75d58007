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
