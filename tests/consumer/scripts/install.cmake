# Installs a build into an emptied prefix: cmake -DBUILD=.. -DPREFIX=.. -P install.cmake
file(REMOVE_RECURSE ${PREFIX})
execute_process(COMMAND ${CMAKE_COMMAND} --install ${BUILD} --prefix ${PREFIX}
                COMMAND_ERROR_IS_FATAL ANY)
# With what there is to read.
foreach(file README.md LICENSE docs/cameras.md docs/images/engine.png examples/engine.json
        examples/farm/parallel.sh)
    if(NOT EXISTS ${PREFIX}/share/doc/deltasplat/${file})
        message(FATAL_ERROR "share/doc/deltasplat/${file} is not installed")
    endif()
endforeach()
