# Files with several volumes and DICOM folders with several series: --volume and --series.

# What a command of those below writes.
function(output_of word result)
    set(file out.vdb)
    if(word STREQUAL render)
        set(file out.exr)
    elseif(word STREQUAL bench)
        set(file "")
    endif()
    set(${result} "${file}" PARENT_SCOPE)
endfunction()

# Every command that reads volumes asks which one, and takes the answer.
foreach(file several.nii several.npy)
    set(axes "dims 4x3x2x5")
    if(file STREQUAL several.npy)
        set(axes "shape (5, 2, 3, 4)")
    endif()
    foreach(command "render;${file};-o;out.exr" "convert;${file};out.vdb" "delta;${file};out.vdb"
            "bench;${file};--size;8x8;--repeats;1")
        list(GET command 0 word)
        deltasplat_cli_test(several.asks.${word}.${file} EXIT 3 ARGS ${command}
            STDERR "deltasplat: ${file}: got 5 volumes (${axes}); expected one, chosen by --volume 0 to 4")
        deltasplat_cli_test(several.beyond.${word}.${file} EXIT 3 ARGS ${command} --volume 5
            STDERR "deltasplat: ${file}: got no volume 5 among 5 volumes (${axes}); expected --volume 0 to 4")
        output_of(${word} creates)
        deltasplat_cli_test(several.takes.${word}.${file} ARGS ${command} --volume 4 -qq
            CREATES ${creates})
    endforeach()
    deltasplat_cli_test(several.restore.${file} EXIT 3 ARGS restore ${file} out.vdb
        STDERR "deltasplat: ${file}: got another format; expected a .vdb of delta grids (convert takes other formats)")
    deltasplat_cli_test(several.info.${file} ARGS info ${file}
        STDOUT_MATCHES "volume +0 of 5, --volume 0 to 4.*range +0 to 23")
    deltasplat_cli_test(several.info_one.${file} ARGS info ${file} --volume 3
        STDOUT_MATCHES "volume +3 of 5, --volume 0 to 4.*range +300 to 323")
    deltasplat_cli_test(several.info_json.${file} ARGS info ${file} --volume 3 --json
        STDOUT_MATCHES "\"series\": null.*\"volume\": 3.*\"volumes\": 5.*\"range\": .[ \n]*300.0,[ \n]*323.0")
endforeach()
deltasplat_cli_test(several.list ARGS info --list several.nii several.npy fourth.nii
    STDOUT_MATCHES "several.nii
  several  int16  -  [(]0, 0, 0[)] to [(]3, 2, 1[)]  5 volumes
several.npy
  several  int16  -  [(]0, 0, 0[)] to [(]3, 2, 1[)]  5 volumes
fourth.nii
  fourth  int16  -  [(]0, 0, 0[)] to [(]3, 2, 1[)]  default$")
deltasplat_cli_test(several.list_json ARGS info --list --json several.nii
    STDOUT_MATCHES "\"series\": null.*\"volumes\": 5.*\"default\": false")
deltasplat_cli_test(several.list_beyond EXIT 3 ARGS info --list several.nii --volume 5
    STDERR "deltasplat: several.nii: got no volume 5 among 5 volumes (dims 4x3x2x5); expected --volume 0 to 4")

# The choice is for what has several: beside it may stand what was made of one.
deltasplat_cli_test(several.diff_asks EXIT 4 ARGS diff several.nii fourth.nii
    STDERR "deltasplat: several.nii: got 5 volumes (dims 4x3x2x5); expected one, chosen by --volume 0 to 4")
deltasplat_cli_test(several.diff ARGS diff several.nii fourth.nii --volume 3 STDOUT_MATCHES "PASS")
deltasplat_cli_test(several.diff_turned ARGS diff fourth.nii several.nii --volume 3
    STDOUT_MATCHES "PASS")
deltasplat_cli_test(several.diff_other EXIT 2 ARGS diff several.nii fourth.nii --volume 2
    STDOUT_MATCHES "Max error = 100 ")
deltasplat_cli_test(several.diff_both ARGS diff several.nii several.npy --volume 3
    STDOUT_MATCHES "PASS")
deltasplat_cli_test(several.diff_single EXIT 4 ARGS diff fourth.nii fourth.nii --volume 3
    STDERR "deltasplat: fourth.nii: got no volume 3 among 1 volume (dims 4x3x2); expected --volume 0")
deltasplat_cli_test(several.only_one EXIT 3 ARGS render fourth.nii -o out.exr --volume 3
    STDERR "deltasplat: fourth.nii: got no volume 3 among 1 volume (dims 4x3x2); expected --volume 0")

# Where there is nothing to choose among, wrong usage: something else would be read.
foreach(file ball.vdb cube_8x8x8_uint8.raw stack.1.pgm)
    foreach(command "render;${file};-o;out.exr" "convert;${file};out.vdb" "delta;${file};out.vdb"
            "info;${file}" "info;--list;${file}" "bench;${file}")
        string(REPLACE ";" " " name "${command}")
        string(MAKE_C_IDENTIFIER "${name}" name)
        deltasplat_cli_test(several.no_volumes.${name} EXIT 2 ARGS ${command} --volume 1
            STDERR "deltasplat: --volume: got 1; expected it with a .nii, .nrrd, .mha, .npy or .tif input")
        deltasplat_cli_test(several.no_series.${name} EXIT 2 ARGS ${command} --series 1.2
            STDERR "deltasplat: --series: got 1.2; expected it with a DICOM input")
    endforeach()
endforeach()
deltasplat_cli_test(several.no_volumes.diff EXIT 4 ARGS diff ball.vdb ball.vdb --volume 0
    STDERR "deltasplat: --volume: got 0; expected it with a .nii, .nrrd, .mha, .npy or .tif input")
deltasplat_cli_test(several.series_of_nifti EXIT 2 ARGS info several.nii --series 1.2
    STDERR "deltasplat: --series: got 1.2; expected it with a DICOM input")
foreach(text -1 1.5 all 99999999999999999999)
    deltasplat_cli_test(several.odd.${text} EXIT 2 ARGS info several.nii --volume=${text}
        STDERR_MATCHES "deltasplat: --volume: got ${text}; expected a whole number .*")
endforeach()

# Headers that lie.
deltasplat_bad_input(volumes_cut
    "less.nii: got 592 bytes; expected at least 640 (352 skipped + 6 volumes of 4x3x2 int16)"
    less.nii --volume 0)
deltasplat_bad_input(volumes_negative
    "negative.nii: got dims 4x3x2x-5; expected each 1..1073741824" negative.nii --volume 0)
deltasplat_bad_input(volumes_endless
    "endless.nii: got dims 4x3x2x32767x32767x32767x32767; expected at most 4611686018427387904 bytes"
    endless.nii --volume 0)

if(NOT DELTASPLAT_DICOM)
    return()
endif()
set(all "1.2.1 (CT, Thorax 1.5 mm, 3x2x4), 1.2.2 (CT, Scout, 5x2x4), 1.2.3 (SR, Dose report, 1 file)")
foreach(command "render;series;-o;out.exr" "convert;series;out.vdb" "delta;series;out.vdb"
        "bench;series;--size;8x8;--repeats;1")
    list(GET command 0 word)
    deltasplat_cli_test(several.asks.${word}.series EXIT 3 ARGS ${command}
        STDERR "deltasplat: series: got 3 DICOM series: ${all}; expected one, chosen by --series UID")
    deltasplat_cli_test(several.beyond.${word}.series EXIT 3 ARGS ${command} --series 1.2
        STDERR "deltasplat: series: got no DICOM series 1.2; expected --series of ${all}")
    output_of(${word} creates)
    deltasplat_cli_test(several.takes.${word}.series ARGS ${command} --series 1.2.2 -qq
        CREATES ${creates})
endforeach()
deltasplat_cli_test(several.info.series ARGS info series
    STDOUT_MATCHES "series +1.2.1: CT, Thorax 1.5 mm.*dims +3 x 2 x 4.*series +1.2.2: CT, Scout.*dims +5 x 2 x 4.*voxel size +1 x 1 x 2.*not read +1.2.3: SR, Dose report [(]no images[)]")
deltasplat_cli_test(several.info_one.series ARGS info series --series 1.2.2
    STDOUT_MATCHES "^series
  grid +series
  type +uint16
  class +unknown
  series +1.2.2: CT, Scout
  dims +5 x 2 x 4
")
deltasplat_cli_test(several.info_json.series ARGS info series --json
    STDOUT_MATCHES "\"series\": \"1.2.1\",[ \n]*\"description\": \"CT, Thorax 1.5 mm\".*\"series\": \"1.2.2\"")
deltasplat_cli_test(several.list.series ARGS info --list series thorax
    STDOUT_MATCHES "^series
  series  uint16     -  [(]0, 0, 0[)] to [(]2, 1, 3[)]  series 1.2.1: CT, Thorax 1.5 mm
  series  uint16     -  [(]0, 0, 0[)] to [(]4, 1, 3[)]  series 1.2.2: CT, Scout
  series  no images  -  -                       series 1.2.3: SR, Dose report  not read
thorax
  thorax  uint16  -  [(]0, 0, 0[)] to [(]2, 1, 3[)]  series 1.2.7: CT, Copy  default$")
deltasplat_cli_test(several.list_json.series ARGS info --list --json series
    STDOUT_MATCHES "\"series\": \"1.2.1\",[ \n]*\"description\": \"CT, Thorax 1.5 mm\",[ \n]*\"volumes\": 1")
deltasplat_cli_test(several.diff.series ARGS diff series thorax --series 1.2.1 STDOUT_MATCHES "PASS")
deltasplat_cli_test(several.diff_other.series EXIT 2 ARGS diff series thorax --series 1.2.2
    STDOUT_MATCHES "FAILURE")

# A study is the slices below it, whatever else lies there.
set(beside "deltasplat: warning: study: 1 file that is no DICOM is passed over, logo.png")
deltasplat_cli_test(several.list.study ARGS info --list study STDERR "${beside}"
    STDOUT_MATCHES "^study
  study  uint16  -  [(]0, 0, 0[)] to [(]2, 1, 1[)]  series 1.2.8: CT, head
  study  uint16  -  [(]0, 0, 0[)] to [(]2, 1, 1[)]  series 1.2.9: CT, legs")
deltasplat_cli_test(several.asks.study EXIT 3 ARGS render study -o out.exr
    STDERR "${beside}
deltasplat: study: got 2 DICOM series: 1.2.8 (CT, head, 3x2x2), 1.2.9 (CT, legs, 3x2x2); expected one, chosen by --series UID")
deltasplat_cli_test(several.one_file ARGS info study/legs/IM1
    STDOUT_MATCHES "grid +IM1.*dims +3 x 2 x 1.*range +10 to 15")
