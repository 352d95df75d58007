// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "bench/bench_page_parts.h"
#include "bench/bench_words.h"
#include "bench/heat_map.h"
#include "page/page_parts.h"
#include "page/picture_data.h"
#include "render/render_stats.h"

namespace deltasplat {
namespace {

std::string heatFigure(const BenchRun& run, const ToleranceRuns& runs) {
    const double full = std::max(runs.measured.color, runs.measured.alpha);
    const std::string caption = "<b>difference</b>, the largest of a pixel's channels" +
                                std::string(full > 0 ? "" : ": 0") +
                                "\n<div class=\"heat\" style=\"background:" + heatGradient() +
                                "\"></div>\n<div class=\"ticks quiet\"><span>0</span><span>" +
                                errorText(full / 2) + "</span><span>" + errorText(full) +
                                "</span></div>";
    return pictureFigure(pngDataUri(heatMap(runs.exact, run.picture, full)),
                         "Where the two pictures differ", caption);
}

std::string stampsText(std::uint64_t deltas, std::uint64_t stamps) {
    return "<p class=\"quiet\">" + groupedText(deltas) + " deltas, " + groupedText(stamps) +
           " stamps by delta</p>";
}

std::string boundTable(const ToleranceRuns& runs) {
    const auto row = [](const std::string& channel, double bound, double measured) {
        const bool share = bound > 0 && std::isfinite(bound);
        return tableRow("td", {channel, errorText(bound), errorText(measured),
                               share ? fixedText(100 * measured / bound, 1) + " %" : "-"});
    };
    return "<div class=\"card\">\n<h3>Largest error of a pixel</h3>\n<div "
           "class=\"scroll\"><table>\n"
           "<thead>" +
           tableRow("th", {"channel", "proved bound", "measured", "of the bound"}) +
           "</thead>\n<tbody>\n" + row("colour", runs.bound.color, runs.measured.color) +
           row("alpha", runs.bound.alpha, runs.measured.alpha) +
           "</tbody></table></div>\n<p class=\"quiet\">Scene-linear, premultiplied.</p>\n</div>\n";
}

}  // namespace

std::string toleranceHtml(const BenchRun& run, const ToleranceRuns& runs,
                          const Background& background) {
    const std::string tolerance = toleranceText(runs.tolerance);
    return "<h3>What a tolerance of " + tolerance + " does</h3>\n<div class=\"trio\">\n" +
           pictureFigure(shownPicture(runs.exact, background), "The exact picture",
                         "<b>exact</b>\n" + stampsText(runs.exactDeltas, runs.exactStamps)) +
           pictureFigure(shownPicture(run.picture, background), "The picture under tolerance",
                         "<b>tolerance " + tolerance + "</b>\n" +
                             stampsText(run.stats.deltas, run.of(Method::kDelta).stamps)) +
           heatFigure(run, runs) + "</div>\n" + boundTable(runs);
}

}  // namespace deltasplat
