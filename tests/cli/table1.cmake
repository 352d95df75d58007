# What `bench table1` says and refuses, on small stand-ins under the names that it looks for.
include(${CMAKE_CURRENT_LIST_DIR}/cases.cmake)
set(quick --repeats 1 -q)
set(fuel fuel_64x64x64_uint8.raw)
set(ear ear_region_128x128x30_uint8.raw)
set(head cthead_256x256x225_uint8.raw.gz)
set(engine engine_256x256x128_uint8.raw.gz)

deltasplat_cli_test(help_table1 ARGS bench table1 --help
    STDOUT_MATCHES "Usage: deltasplat bench table1 .*DATA_FOLDER.*--repeats N.*default 7.*--tf FILE.PRESET.*--json.*${fuel}.*${ear}.*${head}.*${engine}.*Examples:.*deltasplat bench table1")
deltasplat_cli_test(help_bench_names_table1 ARGS bench --help STDOUT_MATCHES "Subcommands:.*table1 ")

set(number "[0-9]+([.][0-9]+)?")
set(times " +${number} +${number} %( +${number}){7}")
set(stamps "( +${number}){7}")
deltasplat_cli_test(table1.text ARGS bench table1 table1_all ${quick}
    STDOUT_MATCHES "logical core.*Table 1 .*one pixel a voxel, composite, 1 thread, .*
  footprint 6 x 6 [(]sigma 1.0[)], transfer function: CT ramp.*medians of 1, interleaved.*
  table1_all/${fuel}
  table1_all/deep/${ear}
  table1_all/deep/deeper/${head}
  table1_all/deep/${engine}

exact
.*
  fuel +64x64x64${times} +8[.]06
  ear [*] +128x128x30${times} +6[.]46
  head +256x256x225${times} +5[.]39
  engine +256x256x128${times} +7[.]24
.*
  fuel +262144${stamps}
  ear [*] +491520${stamps}
  head +14745600${stamps}
  engine +8388608${stamps}

  pixels the same, bit for bit: all methods, 2 rounds each

data values held within 2 of 255
.*difference:
.*alpha
  fuel +262144${stamps} +[0-9.e-]+ +[0-9.e-]+
  ear .*
  pixels the same, bit for bit: all methods, 2 rounds each

  [*] a stand-in for the paper's ear data set.*stamps footprints one by one")
# Without a folder, the current one; links to folders are followed.
deltasplat_cli_test(table1.here ARGS bench table1 ${quick} --tf tf_good.json --threads 1
    STDOUT_MATCHES "transfer function: tf_good.json.*[.]/table1_all/${fuel}
")
set(missing "got no such file below table1_some; expected the data set")
deltasplat_cli_test(table1.missing EXIT 3 ARGS bench table1 table1_some ${quick}
    STDERR "deltasplat: table1_some/${fuel}: got 9 bytes; expected 262144 (64x64x64 uint8)
deltasplat: ${head}: ${missing} 'head' of Table 1
deltasplat: ${engine}: ${missing} 'engine' of Table 1"
    STDOUT_MATCHES "
  fuel +not measured +8.06
  ear [*] +128x128x30${times} +6.46
  head +not measured +5.39
")
deltasplat_cli_test(table1.nothing EXIT 3 ARGS bench table1 folder.exr ${quick} --json
    STDERR_MATCHES "deltasplat: ${fuel}: got no such file below folder.exr; .*
deltasplat: ${ear}: .*
deltasplat: ${head}: .*
deltasplat: ${engine}: [^
]*" STDOUT_MATCHES "^$")

# Declares a measurement that is refused before any volume is looked for.
function(deltasplat_table1_refusal name exit message)
    deltasplat_cli_test(table1.refused.${name} EXIT ${exit} STDERR "deltasplat: ${message}"
                        STDOUT_MATCHES "^$" ARGS ${ARGN})
endfunction()
set(one "expected 1, as Table 1 is measured with one thread")
deltasplat_table1_refusal(threads 2 "--threads: got 2; ${one}"
    bench table1 table1_all --threads 2)
deltasplat_table1_refusal(all_threads 2 "--threads: got 0; ${one}"
    bench table1 table1_all --threads 0)
deltasplat_table1_refusal(threads_of_bench 2 "--threads: got 4; ${one}"
    bench --threads 4 table1 table1_all)
deltasplat_table1_refusal(threads_of_all 2 "--threads: got 3; ${one}"
    --threads 3 bench table1 table1_all)
set(behind "got a place before table1; expected options of 'deltasplat bench table1' behind it")
deltasplat_table1_refusal(option_of_bench 2 "--json: ${behind}" bench --json table1 table1_all)
deltasplat_table1_refusal(input_of_bench 2 "INPUT: ${behind}" bench ball.vdb table1 table1_all)
deltasplat_table1_refusal(unknown_option 2 "Unknown option '--repeat'. Did you mean '--repeats'?"
    bench table1 table1_all --repeat 3)
deltasplat_table1_refusal(view 2 "Unknown option '--view'." bench table1 table1_all --view top)
deltasplat_table1_refusal(two_folders 2
    "Unexpected argument 'table1_some'; see 'deltasplat bench table1 --help'"
    bench table1 table1_all table1_some)
deltasplat_table1_refusal(repeats 2 "--repeats: got 0; expected a whole number from 1 to 100000"
    bench table1 table1_all --repeats 0)
deltasplat_table1_refusal(no_folder 3
    "nowhere: got no such folder; expected a folder that holds data sets" bench table1 nowhere)
deltasplat_table1_refusal(a_file 3 "ball.vdb: got a file; expected a folder that holds data sets"
    bench table1 ball.vdb)
deltasplat_table1_refusal(tf 3
    "tf_missing.json: got no such file; expected a transfer function (ParaView's JSON)"
    bench table1 table1_all --tf tf_missing.json)
# What is called table1 can still be measured.
deltasplat_table1_refusal(not_meant 3 "./table1: got no such file; expected a readable file"
    bench ./table1)

set(scripts ${CMAKE_CURRENT_LIST_DIR}/scripts)
add_test(NAME cli.table1.json
         COMMAND ${CMAKE_COMMAND} -DPROGRAM=$<TARGET_FILE:deltasplat_tool>
                 -DDATA=${DELTASPLAT_FIXTURES}/table1_all -P ${scripts}/table1.cmake)
set_tests_properties(cli.table1.json PROPERTIES LABELS cli TIMEOUT 120 FIXTURES_REQUIRED cli_files)
add_test(NAME cli.table1.data
         COMMAND bash ${scripts}/if_present.sh ${DELTASPLAT_SHARED_DATA}
                 ${CMAKE_COMMAND} -DPROGRAM=$<TARGET_FILE:deltasplat_tool>
                 -DDATA=${DELTASPLAT_SHARED_DATA} -P ${scripts}/table1.cmake)
set_tests_properties(cli.table1.data PROPERTIES LABELS "cli;data" TIMEOUT 600 SKIP_RETURN_CODE 77)
