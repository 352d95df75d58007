# What checks of the program's JSON have in common.

# Fails unless the object at a path of the JSON text has exactly these keys.
function(expect_keys json where expected)
    string(JSON count LENGTH "${json}" ${where})
    set(keys)
    math(EXPR last "${count} - 1")
    foreach(i RANGE ${last})
        string(JSON key MEMBER "${json}" ${where} ${i})
        list(APPEND keys ${key})
    endforeach()
    list(SORT keys)
    list(SORT expected)
    if(NOT "${keys}" STREQUAL "${expected}")
        message(FATAL_ERROR "keys of '${where}':\n  got ${keys}\n  expected ${expected}")
    endif()
endfunction()

function(expect_value json expected)
    string(JSON value GET "${json}" ${ARGN})
    if(NOT "${value}" STREQUAL "${expected}")
        message(FATAL_ERROR "${ARGN}: got ${value}; expected ${expected}")
    endif()
endfunction()
