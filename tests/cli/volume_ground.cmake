# The shadow on a ground (scripts/ground.sh looks at pictures of it).
set(lit render ${cube} -o out.exr --size 8x8 --light 0,-1,0 --view top)

foreach(ground 1,2 1,2,x 1,2,3: 1,2,3:0,0,0 1,2,3:1,0 1,2,3:0,1,0:4)
    string(MAKE_C_IDENTIFIER ground_${ground} name)
    deltasplat_refusal(${name}
        "--ground: got ${ground}; expected X,Y,Z, a point of the ground, then, if wanted, :NX,NY,NZ, its normal, not all 0, as in 0,-10,0:0,1,0"
        --ground ${ground})
endforeach()
deltasplat_refusal(ground_mode "--ground: got --mode mip; expected --mode composite"
    --ground 0,0,0 --mode mip)
deltasplat_refusal(ground_unlit
    "--ground: got what shines by itself; expected --lighting scatter, whose lights throw shadows"
    --ground 0,0,0)
deltasplat_refusal(ground_deep "--ground: got --deep besides; expected a flat picture, or --deep alone"
    --ground 0,0,0 --lighting scatter --deep)
deltasplat_refusal(ground_holdout "--ground: got --holdout-depth besides; expected one of the two"
    --ground 0,0,0 --lighting scatter --holdout-depth z.exr)
deltasplat_refusal(aov_shadow
    "--aov shadow: got no --ground; expected --ground X,Y,Z, a point of what it falls on"
    --lighting scatter --aov shadow)
deltasplat_cli_test(usage.ground_aov_png EXIT 2
    ARGS render ${cube} -o out.png --lighting scatter --ground 0,0,0 --aov shadow
    STDERR "deltasplat: --aov: got out.png; expected an .exr file")

deltasplat_cli_test(ground.channels CREATES out.exr
    ARGS ${lit} --lighting scatter --ground 0,0,0 --aov depth,shadow)
deltasplat_cli_test(ground.edge_on CREATES out.exr
    ARGS render ${cube} -o out.exr --size 8x8 --lighting scatter --light 0,-1,0 --ground 0,0,0
    STDERR "deltasplat: warning: --ground: no line of sight meets it from above: it has no shadow here")
deltasplat_cli_test(ground.lit_from_below CREATES out.exr
    ARGS render ${cube} -o out.exr --size 8x8 --lighting scatter --light 0,1,0 --view top --ground 0,0,0
    STDERR "deltasplat: warning: --ground: no light shines on it from above: it has no shadow")
deltasplat_cli_test(ground.through CREATES out.exr
    ARGS ${lit} --lighting scatter --ground 0,2,0
    STDERR "deltasplat: warning: --ground: the volume's box reaches 2 below it; what lies there is seen as if there were no ground, and throws no shadow")

deltasplat_script_test(ground ground.sh
    ARGS ${tool} ${DELTASPLAT_OIIOTOOL} ${scratch}/ground ${DELTASPLAT_FIXTURES}/fire.vdb)
set_tests_properties(cli.ground PROPERTIES FIXTURES_REQUIRED cli_files)
