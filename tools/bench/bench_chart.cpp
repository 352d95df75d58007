// SPDX-License-Identifier: Apache-2.0
#include "bench/bench_chart.h"

#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "bench/bench_words.h"
#include "drawing/nice_step.h"

namespace deltasplat {
namespace {

// Pixels of the picture, which is scaled to the page.
constexpr double kWidth = 760;
constexpr double kLeft = 92;
constexpr double kRight = 640;
constexpr double kTop = 6;
constexpr double kPitch = 50;
constexpr double kBarHeight = 22;
constexpr double kThinHeight = 6;
constexpr double kBottom = kTop + kPitch * double(kBenchMethods.size());

std::string pixels(double value) {
    return numberText(std::round(value * 100) / 100 + 0.0);
}

std::string text(double x, double y, const std::string& attributes, const std::string& content) {
    return "<text x=\"" + pixels(x) + "\" y=\"" + pixels(y) + "\" " + attributes + ">" + content +
           "</text>\n";
}

class Bars {
  public:
    explicit Bars(const BenchRun& run) : run_(run) {
        for (const MethodRuns& method : run.methods) {
            longest_ = std::max({longest_, stagesOf(method), method.prepare.median});
        }
    }

    std::string draw() {
        svg_ = "<svg class=\"bars\" viewBox=\"0 0 " + pixels(kWidth) + " " + pixels(kBottom + 26) +
               "\" role=\"img\" aria-label=\"Medians of the stages of each method\">\n";
        drawScale();
        double top = kTop;
        for (const MethodRuns& method : run_.methods) {
            drawMethod(method, top);
            top += kPitch;
        }
        return svg_ + "</svg>\n";
    }

  private:
    static double stagesOf(const MethodRuns& method) {
        return method.splat.median + method.composite.median + method.warp.median;
    }

    double lengthOf(double seconds) const {
        return longest_ > 0 ? (kRight - kLeft) * seconds / longest_ : 0;
    }

    // Rules with their times in milliseconds.
    void drawScale() {
        const double step = longest_ > 0 ? niceStep(1e3 * longest_, 4) : 1;
        for (int i = 0; i * step <= 1e3 * longest_; ++i) {
            const double x = kLeft + lengthOf(1e-3 * i * step);
            svg_ += "<path class=\"rule\" d=\"M" + pixels(x) + " " + pixels(kTop) + "V" +
                    pixels(kBottom) + "\"/>\n";
            // What a multiple of a step is not to the last digit is no number to read.
            const double shown = std::round(1e6 * i * step) / 1e6;
            svg_ += text(x, kBottom + 18, "class=\"quiet\" text-anchor=\"middle\"",
                         numberText(shown) + (i == 0 ? " ms" : ""));
        }
    }

    void drawMethod(const MethodRuns& method, double top) {
        svg_ += text(kLeft - 10, top + 22, "text-anchor=\"end\"", methodName(method.method));
        double x = kLeft;
        x = drawBar("splat", method.splat.median, x, top + 6, kBarHeight);
        x = drawBar("composite", method.composite.median, x, top + 6, kBarHeight);
        x = drawBar("warp", method.warp.median, x, top + 6, kBarHeight);
        svg_ += text(x + 8, top + 22, "", millisecondsText(method.render.median) + " ms");
        drawBar("prepare", method.prepare.median, kLeft, top + 6 + kBarHeight + 3, kThinHeight);
    }

    // Returns where the bar ends.
    double drawBar(const std::string& stage, double seconds, double x, double y, double height) {
        const double length = lengthOf(seconds);
        svg_ += "<rect class=\"" + stage + "\" x=\"" + pixels(x) + "\" y=\"" + pixels(y) +
                "\" width=\"" + pixels(length) + "\" height=\"" + pixels(height) + "\"><title>" +
                stage + " " + millisecondsText(seconds) + " ms</title></rect>\n";
        return x + length;
    }

    const BenchRun& run_;
    double longest_ = 0;
    std::string svg_;
};

}  // namespace

std::string stageBars(const BenchRun& run) {
    return Bars(run).draw();
}

}  // namespace deltasplat
