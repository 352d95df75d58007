// SPDX-License-Identifier: Apache-2.0
#include <filesystem>

#include "bench/bench_chart.h"
#include "bench/bench_page_parts.h"
#include "bench/bench_page_style.h"
#include "bench/bench_report.h"
#include "bench/bench_words.h"
#include "page/page_parts.h"
#include "text/utf8_text.h"

namespace deltasplat {
namespace {

const char* stampedBy(Method method) {
    switch (method) {
        case Method::kTraditional:
            return "stamps every voxel of the box";
        case Method::kSparse:
            return "stamps every visible voxel";
        case Method::kDelta:
            return "stamps every voxel that changes";
        case Method::kAuto:
            break;
    }
    return "delta for slabs where that is clearly less work, else sparse";
}

std::string fileName(const std::string& input) {
    // A folder of slices may end with a slash.
    const std::filesystem::path path(input);
    return (path.has_filename() ? path : path.parent_path()).filename().string();
}

std::string methodFigure(const BenchRun& run, const MethodRuns& method, const std::string& uri) {
    const std::string name = methodName(method.method);
    const double gain = run.speedup(Method::kTraditional, method.method);
    return pictureFigure(
        uri, "The volume, rendered by " + name,
        "<b>" + name + "</b>" +
            (method.differs ? " <span class=\"different\">other pixels</span>" : "") +
            "\n<p class=\"big\">" + millisecondsText(method.render.median) +
            " <span>ms</span> &nbsp;" + fixedText(gain, 2) + "<span>×</span></p>\n" +
            "<p class=\"quiet\">" + stampedBy(method.method) + ": " + groupedText(method.stamps) +
            "</p>");
}

std::string methodPictures(const BenchRun& run, const Background& background) {
    // Encoded once: what has the same bits looks the same.
    const std::string common = shownPicture(run.picture, background);
    std::string html = "<div class=\"methods\">\n";
    for (const MethodRuns& method : run.methods) {
        html += methodFigure(run, method,
                             method.differs ? shownPicture(*method.differs, background) : common);
    }
    return html + "</div>\n";
}

std::string bars(const BenchRun& run) {
    std::string legend = "<p class=\"legend\">";
    for (const char* stage : {"splat", "composite", "warp", "prepare"}) {
        legend += std::string("<span><i class=\"") + stage + "\"></i>" + stage + "</span>";
    }
    return "<div class=\"card\">\n<h3>Where the time goes</h3>\n" + legend + "</p>\n" +
           stageBars(run) + "<p class=\"quiet\">Medians of " + std::to_string(run.repeats) +
           " rounds. The number is the median of the whole picture. Prepare (classifying, taking "
           "differences) comes once per volume, axis and transfer function.</p>\n</div>\n";
}

std::string timingCell(const Timing& timing) {
    return millisecondsText(timing.median) + " <span class=\"quiet\">(" +
           millisecondsText(timing.min) + ")</span>";
}

std::string table(const BenchRun& run) {
    std::string html =
        "<div class=\"card\">\n<h3>Milliseconds: median (least)</h3>\n"
        "<div class=\"scroll\"><table>\n<thead>" +
        tableRow("th", {"method", "stamps", "prepare", "splat", "composite", "warp", "render",
                        "traditional / it", "sparse / it", "ns a stamp"}) +
        "</thead>\n<tbody>\n";
    for (const MethodRuns& method : run.methods) {
        html += tableRow(
            "td", {methodName(method.method), groupedText(method.stamps),
                   timingCell(method.prepare), timingCell(method.splat),
                   timingCell(method.composite), timingCell(method.warp), timingCell(method.render),
                   fixedText(run.speedup(Method::kTraditional, method.method), 2),
                   fixedText(run.speedup(Method::kSparse, method.method), 2),
                   fixedText(method.nanosecondsPerStamp(), 2)});
    }
    return html + "</tbody></table></div>\n</div>\n";
}

std::string entryHtml(const BenchEntry& entry, const Background& background) {
    const BenchRun& run = entry.run;
    std::string html = "<section>\n<h2>" + markupText(fileName(entry.input)) + "</h2>\n";
    html += "<p>" + volumeText(run) + "</p>\n";
    html += "<p class=\"quiet\">" + markupText(pictureText(entry)) + "</p>\n";
    html += "<p class=\"verdict " + std::string(run.identical ? "same" : "different") +
            "\">Pixels " + identityText(run) + "</p>\n";
    html += methodPictures(run, background) + bars(run) + table(run);
    if (run.tolerance) html += toleranceHtml(run, *run.tolerance, background);
    return html + "</section>\n";
}

std::string footer(const BenchReport& report) {
    return "<footer class=\"quiet\">\n<p>All methods were measured side by side in one process: "
           "each round renders once by each, in an order that moves on by one from round to round; "
           "a first round only warms up. Compare within a volume.</p>\n<p><code>" +
           markupText(report.commandLine) + "</code></p>\n</footer>\n";
}

}  // namespace

std::string pageText(const BenchReport& report, const Background& background) {
    std::string html = pageBegin("deltasplat bench", kBenchPageStyle) + "<header>\n" +
                       "<h1>Four ways to splat one picture</h1>\n<p>" +
                       markupText(hardwareText(report.machine)) + "</p>\n<p class=\"quiet\">" +
                       markupText(softwareText(report.machine)) + "</p>\n</header>\n";
    for (const BenchEntry& entry : report.entries) html += entryHtml(entry, background);
    return html + footer(report) + kPageEnd;
}

}  // namespace deltasplat
