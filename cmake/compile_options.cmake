# Applies the house's compiler settings to one target of ours.
function(deltasplat_compile_options target)
    # Pixels must not depend on whether a compiler fuses a multiply and an add.
    target_compile_options(${target} PRIVATE -ffp-contract=off -Wall -Wextra)
    if(PROJECT_IS_TOP_LEVEL)
        target_compile_options(${target} PRIVATE -Werror)
    endif()
    set_target_properties(${target} PROPERTIES CXX_EXTENSIONS OFF)
endfunction()
