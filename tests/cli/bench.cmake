# What `bench` says, writes and refuses. What it measures depends on the machine and is not looked at.
include(${CMAKE_CURRENT_LIST_DIR}/cases.cmake)
set(cube cube_8x8x8_uint8.raw)
set(quick --repeats 1 --size 16x16)

deltasplat_cli_test(help_bench ARGS bench --help
    STDOUT_MATCHES "--repeats N.*default 7.*--report DIR.*--view.*--tf FILE.PRESET.*--tolerance T.*--grid.*Examples:.*deltasplat bench.*deltasplat bench")

set(number "[0-9]+([.][0-9]+)? +")
set(row "${number}${number}${number}${number}${number}${number}${number}${number}[0-9.]+ +[0-9.]+")
deltasplat_cli_test(bench.table ARGS bench ${cube} ${quick} --extinction 10
    STDOUT_MATCHES "logical core.*
deltasplat ${PROJECT_VERSION}, OpenVDB .*
${cube}
  8 x 8 x 8 voxels divided into 8, .* visible, .* deltas [(]comparability .*
  16 x 16 pixels, composite, .*16 slices along z in .*
  method .*
  traditional +${row}
  sparse +${row}
  delta +${row}
  auto +${row}
  pixels the same, bit for bit: all methods, 2 rounds each$")
deltasplat_cli_test(bench.several ARGS bench ball.vdb ${cube} ${quick}
    STDOUT_MATCHES "
ball.vdb.*traditional.*
${cube}.*traditional")
deltasplat_cli_test(bench.options ARGS bench ${cube} ${quick} --threads 1 --view right --resolution 2
    --sigma 0.5 --tf tf_good.json --spacing 1,1,2 -q
    STDOUT_MATCHES "16 x 16 pixels, composite, 1 thread; 8 slices along x .*, 2 sheet pixels a voxel")
deltasplat_cli_test(bench.tolerance ARGS bench ${cube} ${quick} --tolerance 0.1 --tolerance-value 2
    STDOUT_MATCHES "bit for bit.*
  tolerance 0.1 of the colour and 2 data units: [0-9]+ deltas, exactly [0-9]+
  error bound: +colour .*, alpha .*
  error measured: colour [0-9].*, alpha [0-9]")
deltasplat_cli_test(bench.empty ARGS bench empty.vdb ${quick}
    STDERR "deltasplat: warning: empty.vdb: grid \"density\": no active voxels"
    STDOUT_MATCHES "traditional +0 .* - +- .*auto +0 .*bit for bit")
deltasplat_cli_test(bench.empty_json ARGS bench empty.vdb ${quick} --json -qq
    STDOUT_MATCHES "\"sparse/auto\": null")
deltasplat_cli_test(bench.report ARGS bench ${cube} ${quick} --report out -q CREATES out
    STDOUT_MATCHES "bit for bit")

# A volume that cannot be read does not keep the others from being measured.
deltasplat_cli_test(bench.others_are_told EXIT 3 ARGS bench nowhere.vdb ${cube} ${quick} --json
    STDERR "deltasplat: nowhere.vdb: got no such file; expected a readable file"
    STDOUT_MATCHES "^[{].*\"runs\": .*\"input\": \"${cube}\".*[}]$")

# Declares a measurement that is refused before any picture is made.
function(deltasplat_bench_refusal name exit message)
    deltasplat_cli_test(bench.refused.${name} EXIT ${exit} STDERR "deltasplat: ${message}"
                        STDOUT_MATCHES "^$" ARGS bench ${ARGN})
endfunction()
deltasplat_bench_refusal(missing 3 "nowhere.vdb: got no such file; expected a readable file"
    nowhere.vdb --report out)
deltasplat_bench_refusal(tf_missing 3
    "tf_missing.json: got no such file; expected a transfer function (ParaView's JSON)"
    ${cube} --tf tf_missing.json)
deltasplat_bench_refusal(no_input 2
    "INPUT: got nothing; expected FILE (see 'deltasplat bench --help')" --json)
foreach(repeats 0 -1 1.5 many)
    deltasplat_bench_refusal(repeats_${repeats} 2
        "--repeats: got ${repeats}; expected a whole number from 1 to 100000"
        ${cube} --repeats ${repeats})
endforeach()
deltasplat_bench_refusal(unknown_option 2 "Unknown option '--repeat'. Did you mean '--repeats'?"
    ${cube} --repeat 3)
# All methods are measured, so there is none to choose.
deltasplat_bench_refusal(method 2 "Unknown option '--method'." ${cube} --method delta)
deltasplat_bench_refusal(view 2
    "--view: got side; expected one of front, back, left, right, top, bottom, iso"
    nowhere.vdb --view side)
deltasplat_bench_refusal(report_size 2
    "--size: got 1000001x1; expected sides of at most 1000000 pixels with --report"
    nowhere.vdb --report out --size 1000001x1)
deltasplat_bench_refusal(report_no_folder 4
    "nowhere/out: cannot be written: there is no folder nowhere" nowhere.vdb --report nowhere/out)
deltasplat_bench_refusal(report_is_file 4 "ball.vdb: got a file; expected a folder"
    nowhere.vdb --report ball.vdb)
deltasplat_cli_test(bench.unused.background ARGS bench ${cube} ${quick} --background 0,0,0
    STDERR "deltasplat: warning: --background: has no effect without --report"
    STDOUT_MATCHES "bit for bit")

add_test(NAME cli.bench.page
    COMMAND bash ${CMAKE_CURRENT_LIST_DIR}/scripts/bench_page.sh $<TARGET_FILE:deltasplat_tool>
            ${CMAKE_CURRENT_BINARY_DIR}/cli/bench_page)
set_tests_properties(cli.bench.page PROPERTIES LABELS cli TIMEOUT 120)
