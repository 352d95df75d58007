# Tests of parts of the library and of the program, one program for each room or two.

deltasplat_tests(base_tests unit
    unit/cgroup_test.cpp unit/default_floats_test.cpp unit/kept_memory_test.cpp
    unit/parallel_sort_test.cpp unit/portable_math_test.cpp unit/threads_test.cpp)

deltasplat_tests(files_tests unit
    unit/atomic_file_test.cpp unit/checked_json_test.cpp
    unit/half_exact_test.cpp unit/printable_test.cpp unit/shared_folder_test.cpp)

deltasplat_tests(volume_tests unit
    unit/book_encoder_test.cpp unit/class_ramps_test.cpp unit/code_blocks_test.cpp
    unit/code_book_test.cpp unit/code_kernels_test.cpp unit/cut_volume_test.cpp
    unit/delta_grid_test.cpp unit/float_kernels_test.cpp unit/make_volume_test.cpp
    unit/seen_cone_test.cpp unit/slice_counts_test.cpp unit/tree_grid_test.cpp
    unit/value_statistics_test.cpp unit/vdb_metadata_test.cpp unit/vdb_transform_test.cpp)

deltasplat_tests(image_tests unit
    unit/color_management_test.cpp unit/encode_png_test.cpp unit/exr_camera_test.cpp
    unit/exr_options_test.cpp unit/hold_out_test.cpp unit/image_test.cpp unit/thumbnail_test.cpp
    unit/tone_test.cpp unit/write_deep_image_test.cpp)

deltasplat_tests(view_tests unit
    unit/camera_test.cpp unit/factorization_test.cpp unit/film_camera_test.cpp
    unit/joined_slants_test.cpp)

deltasplat_tests(optics_tests unit
    unit/blackbody_test.cpp unit/class_table_test.cpp unit/color_path_test.cpp
    unit/label_changes_test.cpp unit/presets_test.cpp unit/read_transfer_function_test.cpp
    unit/transfer_function_test.cpp)

deltasplat_tests(foreign_bytes_tests unit
    unit/read_delta_error_test.cpp unit/read_meta_test.cpp unit/read_nifti_error_test.cpp
    unit/read_nrrd_test.cpp unit/read_raw_error_test.cpp unit/read_vdb_error_test.cpp)

deltasplat_tests(formats_tests unit
    unit/column_decoder_test.cpp unit/commit_pair_test.cpp unit/compare_volumes_test.cpp
    unit/delta_stream_test.cpp
    unit/dense_header_test.cpp unit/described_images_test.cpp unit/drop_background_test.cpp
    unit/image_claims_test.cpp unit/input_files_test.cpp unit/json_camera_test.cpp
    unit/packed_volume_test.cpp unit/raw_format_test.cpp unit/read_images_test.cpp
    unit/read_later_test.cpp unit/read_nifti_test.cpp unit/read_npy_test.cpp
    unit/read_raw_test.cpp unit/read_vdb_test.cpp unit/read_vdb_grids_test.cpp
    unit/usd_camera_test.cpp unit/usd_volume_test.cpp unit/vdb_tree_test.cpp
    unit/vdb_values_test.cpp unit/vdb_walk_test.cpp unit/write_dense_test.cpp
    unit/write_grids_test.cpp unit/write_vdb_test.cpp)

deltasplat_tests(words_tests unit
    unit/block_gradients_test.cpp unit/join_probe_test.cpp
    unit/packed_deltas_test.cpp unit/slab_plan_test.cpp unit/slice_joiner_test.cpp
    unit/value_mixer_test.cpp)

deltasplat_tests(light_tests unit
    unit/cut_into_lights_test.cpp unit/emission_lights_test.cpp unit/point_depths_test.cpp
    unit/read_environment_test.cpp unit/sky_test.cpp)

deltasplat_tests(splat_tests unit
    unit/cover_test.cpp unit/deep_builder_test.cpp unit/depth_builder_test.cpp
    unit/footprint_test.cpp unit/halved_raster_test.cpp unit/layer_test.cpp
    unit/ray_kernels_test.cpp unit/scaled_kernels_test.cpp unit/sheet_test.cpp
    unit/splatter_test.cpp unit/tile_kernels_test.cpp unit/warp_test.cpp)

deltasplat_tests(synth_tests unit
    unit/analytic_volume_test.cpp unit/fire_test.cpp unit/write_analytic_test.cpp)

if(DELTASPLAT_DICOM)
    deltasplat_tests(dicom_tests unit
        unit/read_dicom_test.cpp unit/read_dicom_files_test.cpp unit/read_dicom_frames_test.cpp
        unit/read_dicom_values_test.cpp)
endif()

# Does to the helper what foreign libraries do.
deltasplat_helper_work(fault unit/helper_fault.cpp)

# What the program has besides the library.
set(tools ${PROJECT_SOURCE_DIR}/tools)
deltasplat_tests(tools_tests unit
    unit/annotate_test.cpp unit/bench_picture_test.cpp unit/bench_runs_test.cpp
    unit/drawing_test.cpp unit/file_pattern_test.cpp unit/flag_names_test.cpp
    unit/frame_list_test.cpp unit/frame_name_test.cpp unit/helper_process_test.cpp
    unit/index_page_test.cpp unit/interrupt_test.cpp unit/large_pages_test.cpp
    unit/listener_test.cpp unit/memory_gate_test.cpp unit/output_name_test.cpp
    unit/picture_legend_test.cpp unit/poses_test.cpp unit/preview_file_test.cpp
    unit/sequence_look_test.cpp unit/slice_plot_test.cpp unit/table1_test.cpp
    unit/value_window_test.cpp
    SOURCES
    ${tools}/annotate/annotate.cpp ${tools}/annotate/annotation.cpp ${tools}/annotate/axes.cpp
    ${tools}/annotate/ink.cpp ${tools}/annotate/legend.cpp ${tools}/annotate/scale_bar.cpp
    ${tools}/annotate/text_lines.cpp ${tools}/batch/file_pattern.cpp
    ${tools}/batch/index_page.cpp ${tools}/batch/memory_gate.cpp ${tools}/batch/output_name.cpp
    ${tools}/bench/bench_page_file.cpp ${tools}/bench/bench_runs.cpp
    ${tools}/bench/bench_words.cpp ${tools}/bench/heat_map.cpp ${tools}/camera/poses.cpp
    ${tools}/drawing/drawing_raster.cpp ${tools}/drawing/drawing_svg.cpp
    ${tools}/drawing/plot_file.cpp ${tools}/drawing/stroke_font.cpp ${tools}/flag_names.cpp
    ${tools}/info/slice_plot.cpp ${tools}/listener.cpp ${tools}/options/file_and_name.cpp
    ${tools}/options/parse.cpp ${tools}/options/transfer_function_option.cpp
    ${tools}/page/page_parts.cpp ${tools}/page/picture_data.cpp ${tools}/process/interrupt.cpp
    ${tools}/process/large_pages.cpp ${tools}/process/reuse_memory.cpp
    ${tools}/process/run_log.cpp ${tools}/process/tell_place.cpp
    ${tools}/render/list_presets.cpp ${tools}/render/picture_legend.cpp
    ${tools}/render/preview_file.cpp ${tools}/render/render_stats.cpp
    ${tools}/render/value_window.cpp ${tools}/sequence/frame_list.cpp
    ${tools}/sequence/frame_name.cpp ${tools}/sequence/sequence_look.cpp
    ${tools}/table1/ct_ramp.cpp ${tools}/table1/table1.cpp ${tools}/text/utf8_text.cpp
    ${tools}/version.cpp ${tools}/volume_place.cpp)
target_compile_definitions(tools_tests PRIVATE DELTASPLAT_VERSION="${PROJECT_VERSION}")
