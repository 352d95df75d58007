// SPDX-License-Identifier: Apache-2.0
#include "options/command_line.h"

#include <algorithm>

#include "deltasplat/error.h"
#include "version.h"

namespace deltasplat {

bool OptionGroup::isMoreGiven(const CLI::App& app, const std::string& name) {
    const std::vector<const CLI::Option*> options = app.get_options();
    return std::any_of(options.begin(), options.end(), [&](const CLI::Option* option) {
        return option->count() > 0 && !option->check_name(name) &&
               option->get_group() != kCommonTitle;
    });
}

std::string withDefault(const std::string& help, const std::string& value) {
    return help + " (default " + value + ")";
}

bool isGiven(const CLI::App& app, const std::string& name) {
    return app.get_option(name)->count() > 0;
}

CLI::App& addSubcommand(CLI::App& program, const std::string& name, const std::string& summary,
                        const std::vector<std::string>& examples) {
    CLI::App& app = *program.add_subcommand(name, summary);
    // What CLI11 does not know is reported by us, with a suggestion.
    app.allow_extras();
    std::string footer = "Examples:";
    for (const std::string& example : examples) footer += "\n  " + example;
    app.footer(footer);
    return app;
}

void addCommonOptions(CLI::App& app, CommonOptions& options) {
    app.set_help_flag("-h,--help", "Show this help and end")->group(kCommonTitle);
    app.set_version_flag("--version", versionText, "Show the versions in use and end")
        ->group(kCommonTitle);
    OptionGroup group(app, kCommonTitle);
    group.addCount("-q,--quiet", options.quiet, "Show no progress; -qq: no warnings either");
    group.addFlag("-v,--verbose", options.verbose, "Say more about what is done and what failed");
    group.addFlag("--progress", options.progress,
                  "Show progress from the start where standard error is no terminal, too:\n"
                  "lines \"Progress: 10%\", as -v does; else after five seconds");
    group.addFlag("--alf-progress", options.alfProgress,
                  "The same as lines \"ALF_PROGRESS 10%\", which render farms read");
    group.addValue("--log", "FILE", options.log, anyText(),
                   "Add lines to this file: the command line, warnings, errors, progress,\n"
                   "and last exit code, seconds and most memory held, each with the time");
    group.addFlag("--json-log", options.jsonLog, "Make each line of --log a JSON object");
    group.addValue("--threads", "N", options.threads, wholeNumber(0, 1024),
                   withDefault("Threads to use, 0 = all", std::to_string(options.threads)));
    group.addValue("--max-memory", "SIZE", options.maxMemory, byteCount(),
                   "Refuse up front what would take more memory than this, such as 4G,\n"
                   "the program itself (20M; with .jpg, DICOM and other formats of libraries\n"
                   "150M) included\n"
                   "(default: what the machine has)");
    group.addFlag("--fsync", options.fsync,
                  "End only when what was written would outlive a power failure");
    group.addValue(
        "--simd", "LEVEL", options.simd, anyText(),
        withDefault("SIMD level, a name from --version; never changes a pixel", options.simd));
}

void requireArgument(bool given, const std::string& name, const std::string& expected) {
    if (!given) throw Error(ErrorCode::kUsage, name, "nothing", expected);
}

}  // namespace deltasplat
