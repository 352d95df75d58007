# Sequences that are killed, have no room or are written twice.
foreach(name killed_sequence full_disk_sequence two_writers threads)
    deltasplat_script_test(${name} ${name}.sh
        ARGS ${tool} ${DELTASPLAT_OIIOTOOL} ${scratch}/${name} ${DELTASPLAT_FIXTURES}/frustum.vdb)
    set_tests_properties(cli.${name} PROPERTIES SKIP_RETURN_CODE 77 FIXTURES_REQUIRED cli_files)
endforeach()
