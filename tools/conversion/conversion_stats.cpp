// SPDX-License-Identifier: Apache-2.0
#include "conversion/conversion_stats.h"

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <system_error>

#include "options/parse.h"
#include "process/peak_bytes.h"
#include "text/json_text.h"
#include "volume/code_math.h"

namespace deltasplat {

namespace fs = std::filesystem;

void ConversionStats::add(const Volume& volume, const std::string& codeBook) {
    voxels += voxelsOf(volume.box());
    active += volume.activeCount();
    maxError = std::max(maxError, volume.readError());
    lossless = lossless && volume.replaced() == 0 && volume.readError() == 0;
    areLabels = areLabels || volume.labels();
    addBook(codeBook);
}

void ConversionStats::add(const ConversionStats& other) {
    inputBytes += other.inputBytes;
    outputBytes += other.outputBytes;
    voxels += other.voxels;
    active += other.active;
    deltas += other.deltas;
    maxError = std::max(maxError, other.maxError);
    lossless = lossless && other.lossless;
    for (const std::string& book : other.codeBooks) addBook(book);
}

void ConversionStats::addBook(const std::string& book) {
    if (std::find(codeBooks.begin(), codeBooks.end(), book) == codeBooks.end())
        codeBooks.push_back(book);
}

std::uint64_t bytesOf(const std::vector<fs::path>& files) {
    std::uint64_t bytes = 0;
    std::error_code ignored;
    for (const fs::path& file : files) {
        if (fs::is_regular_file(file, ignored)) bytes += fs::file_size(file, ignored);
    }
    return bytes;
}

std::string statsJson(const ConversionStats& stats) {
    return dumpJson({
        {"input_bytes", stats.inputBytes},
        {"output_bytes", stats.outputBytes},
        {"voxels", stats.voxels},
        {"active", stats.active},
        {"deltas", stats.deltas},
        {"code_book", joinNames(stats.codeBooks)},
        {"max_error", stats.maxError},
        {"lossless", stats.lossless},
        {"seconds", stats.seconds},
        {"peak_bytes", peakBytes()},
    });
}

std::string statsSummary(const ConversionStats& stats) {
    char text[512];
    std::snprintf(text, sizeof text,
                  "%llu of %llu voxels active, code book %s\n"
                  "%llu bytes read, %llu bytes written, largest error %g, %.3f seconds\n",
                  (unsigned long long)stats.active, (unsigned long long)stats.voxels,
                  joinNames(stats.codeBooks).c_str(), (unsigned long long)stats.inputBytes,
                  (unsigned long long)stats.outputBytes, stats.maxError, stats.seconds);
    return text;
}

}  // namespace deltasplat
