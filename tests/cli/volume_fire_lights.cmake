# Fire that lights the fog around it (scripts/fire_lights.sh looks at pictures of it).
set(fire render fire.vdb -o out.exr --size 8x8 --grid density)

deltasplat_cli_test(fire_lights.all CREATES out.exr
    ARGS ${fire} --emission-grid temperature --lighting scatter --emission-lights 3)
deltasplat_cli_test(fire_lights.layers CREATES out.exr
    ARGS render fire.vdb -o out.exr --size 8x8 --layer density:grey --layer temperature:fire --lighting scatter
         --emission-lights 3)
foreach(count 0 4097 1.5 x)
    deltasplat_cli_test(usage.emission_lights_${count} EXIT 2
        ARGS ${fire} --emission-grid temperature --lighting scatter --emission-lights ${count}
        STDERR "deltasplat: --emission-lights: got ${count}; expected a whole number from 1 to 4096")
endforeach()
deltasplat_cli_test(fire_lights.unlit EXIT 2
    ARGS ${fire} --emission-grid temperature --emission-lights 3
    STDERR "deltasplat: --emission-lights: got it without --lighting scatter; expected --lighting scatter, fog that they light")
deltasplat_cli_test(fire_lights.no_fire EXIT 2
    ARGS ${fire} --lighting scatter --emission-lights 3
    STDERR "deltasplat: --emission-lights: got it without fire; expected --emission-grid, or a --layer shown as fire")
deltasplat_unused(fire_lights_mode --emission-lights "with --mode xray" CREATES out.exr
    ARGS ${fire} --mode xray --emission-lights 3)
deltasplat_unused(fire_lights_sky --turbidity "without --sky" CREATES out.exr
    ARGS ${fire} --emission-grid temperature --lighting scatter --emission-lights 3 --turbidity 4)
deltasplat_cli_test(fire_lights.cold CREATES out.exr
    ARGS ${fire} --emission-grid cold --temperature-scale 1000 --lighting scatter --emission-lights 3
    STDERR "deltasplat: warning: --emission-grid: nothing of cold glows, for the hottest has 100 K, and nothing below 500 K is seen to
deltasplat: warning: --emission-lights: nothing shines that could light the fog")

deltasplat_script_test(fire_lights fire_lights.sh
    ARGS ${tool} ${DELTASPLAT_OIIOTOOL} ${scratch}/fire_lights ${DELTASPLAT_FIXTURES}/fire.vdb)
set_tests_properties(cli.fire_lights PROPERTIES FIXTURES_REQUIRED cli_files)
