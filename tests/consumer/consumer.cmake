# Two projects that use the library, each built and run: one finds it installed, one takes in its
# sources. They are compiled as this build is, and in folders as deep as its own, so that ccache
# (which keeps paths relative to the folder of a build) has the library's objects already.
set(DELTASPLAT_PREFIX ${CMAKE_CURRENT_BINARY_DIR}/consumer/prefix)

set(launcher ${CMAKE_CXX_COMPILER_LAUNCHER})
if(launcher MATCHES "/ccache$")
    set(launcher ${CMAKE_CURRENT_LIST_DIR}/scripts/ccache.sh)
endif()

function(deltasplat_consumer_test name)
    set(folder ${PROJECT_BINARY_DIR}-consumer-${name})
    add_test(NAME consumer.${name}
             COMMAND ${CMAKE_CTEST_COMMAND}
                     --build-and-test ${CMAKE_CURRENT_SOURCE_DIR}/consumer/${name} ${folder}
                     --build-generator ${CMAKE_GENERATOR} --build-noclean
                     --build-options -DCMAKE_BUILD_TYPE=${CMAKE_BUILD_TYPE}
                                     -DDELTASPLAT_WERROR=${DELTASPLAT_WERROR}
                                     -DCMAKE_CXX_COMPILER=${CMAKE_CXX_COMPILER}
                                     -DCMAKE_CXX_COMPILER_LAUNCHER=${launcher}
                                     "-DCMAKE_CXX_FLAGS=${CMAKE_CXX_FLAGS}" ${ARGN}
                     --test-command ${folder}/consumer)
    set_tests_properties(consumer.${name} PROPERTIES LABELS consumer TIMEOUT 5400)
endfunction()

# The prefix is written anew, so that a file which is no longer installed is missed.
add_test(NAME consumer.install
         COMMAND ${CMAKE_COMMAND} -DBUILD=${PROJECT_BINARY_DIR} -DPREFIX=${DELTASPLAT_PREFIX}
                 -P ${CMAKE_CURRENT_LIST_DIR}/scripts/install.cmake)
set_tests_properties(consumer.install PROPERTIES LABELS consumer FIXTURES_SETUP installed)
deltasplat_consumer_test(find_package -DCMAKE_PREFIX_PATH=${DELTASPLAT_PREFIX})
set_tests_properties(consumer.find_package PROPERTIES FIXTURES_REQUIRED installed)
deltasplat_consumer_test(add_subdirectory)
# Compiles the whole library, on as many threads as there are, where ccache has not what it needs.
set_tests_properties(consumer.add_subdirectory PROPERTIES PROCESSORS 2)
