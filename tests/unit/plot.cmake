# Pictures of numbers, which the program draws.
set(tools ${PROJECT_SOURCE_DIR}/tools)
deltasplat_test(unit/drawing_test.cpp SOURCES ${tools}/drawing/drawing_raster.cpp
    ${tools}/drawing/drawing_svg.cpp ${tools}/drawing/plot_file.cpp ${tools}/drawing/stroke_font.cpp
    ${tools}/text/utf8_text.cpp)
deltasplat_test(unit/slice_plot_test.cpp SOURCES ${tools}/drawing/drawing_svg.cpp
    ${tools}/info/slice_plot.cpp ${tools}/drawing/stroke_font.cpp ${tools}/text/utf8_text.cpp)

# What is drawn over pictures.
set(annotate ${tools}/annotate/annotate.cpp ${tools}/annotate/annotation.cpp
    ${tools}/annotate/axes.cpp ${tools}/annotate/ink.cpp ${tools}/annotate/legend.cpp
    ${tools}/annotate/scale_bar.cpp ${tools}/annotate/text_lines.cpp)
deltasplat_test(unit/annotate_test.cpp SOURCES ${annotate} ${tools}/drawing/drawing_raster.cpp
    ${tools}/drawing/stroke_font.cpp ${tools}/text/utf8_text.cpp)
deltasplat_test(unit/picture_legend_test.cpp SOURCES ${tools}/render/picture_legend.cpp
    ${tools}/render/list_presets.cpp ${tools}/options/transfer_function_option.cpp
    ${tools}/options/file_and_name.cpp)
