#include "image/output_set.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <mutex>
#include <set>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include "earthshine/error.hpp"

namespace fs = std::filesystem;

namespace earthshine {

namespace {

// Guards every set's list, so that a signal's handler sees either an output's temporary or its final name.
std::mutex& mutex() {
    static std::mutex instance;
    return instance;
}

std::set<OutputSet*>& allSets() {
    static std::set<OutputSet*> instance;
    return instance;
}

std::string hiddenName(const fs::path& path, const char* ending) {
    static int counter = 0;
    return fmt::format(".{}.{}-{}.{}", path.filename().string(), ::getpid(), counter++, ending);
}

// A file's temporary one stands in a folder of its own: once that is gone, whoever is about to open the file by its
// name cannot make it anew.
fs::path hiddenFolder(const fs::path& path, const fs::path& temporary) {
    return temporary.parent_path() == path.parent_path() ? temporary : temporary.parent_path();
}

void removeWhole(const fs::path& folder) noexcept {
    constexpr int kMostTries = 100;  // another thread may put a file into it between the removal of both
    std::error_code error;
    for (int i = 0; i < kMostTries; ++i) {
        fs::remove_all(folder, error);
        if (!error) return;
    }
}

[[noreturn]] void refuse(const fs::path& path, std::string_view what, int code) {
    throw Error(fmt::format("{}: {}: {}", path.string(), what, std::strerror(code)));
}

}  // namespace

OutputSet::OutputSet() {
    const std::lock_guard lock(mutex());
    allSets().insert(this);
}

OutputSet::~OutputSet() {
    const std::lock_guard lock(mutex());
    allSets().erase(this);
    discard();
}

void OutputSet::announce(const fs::path& path, Output& output) const {
    std::error_code error;
    output.path = path;
    fs::path plain = fs::absolute(path, error).lexically_normal();
    if (!plain.has_filename()) plain = plain.parent_path();  // "folder/" is "folder"
    if (path.empty() || !plain.has_filename())
        throw UsageError(fmt::format("'{}': not the name of an output", path.string()));
    // A link is followed, so that its target gets replaced and not the link.
    output.resolved = fs::weakly_canonical(plain, error);
    if (error) output.resolved = plain;
    if (resolved_.contains(output.resolved))
        throw UsageError(fmt::format("{}: two outputs have this path; give each its own", path.string()));
    if (const fs::path folder = output.resolved.parent_path(); !fs::is_directory(folder, error))
        throw Error(fmt::format("{}: there is no folder {}; make it first", path.string(), folder.string()));
}

fs::path OutputSet::addFile(const fs::path& path) {
    const std::lock_guard lock(mutex());
    Output output;
    announce(path, output);
    std::error_code error;
    const fs::file_status status = fs::status(output.resolved, error);
    if (fs::exists(status) && !fs::is_regular_file(status))
        throw Error(fmt::format("{}: is no file; choose another name", path.string()));
    const fs::path hidden = output.resolved.parent_path() / hiddenName(output.resolved, "tmp");
    if (!fs::create_directory(hidden, error)) refuse(path, "cannot be written", error.value());
    output.temporary = hidden / output.resolved.filename();
    const int file = ::open(output.temporary.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0666);
    if (file < 0) {
        const int code = errno;
        removeWhole(hidden);
        refuse(path, "cannot be written", code);
    }
    ::close(file);
    outputs_.push_back(output);
    resolved_.insert(output.resolved);
    return output.temporary;
}

fs::path OutputSet::addFolder(const fs::path& path, const std::string& marker) {
    const std::lock_guard lock(mutex());
    Output output;
    announce(path, output);
    std::error_code error;
    if (fs::exists(output.resolved, error)) {
        if (!fs::is_directory(output.resolved, error))
            throw Error(fmt::format("{}: is no folder; choose another name", path.string()));
        if (!fs::is_empty(output.resolved, error) && !fs::exists(output.resolved / marker, error))
            throw Error(fmt::format("{}: holds other things than an earlier {}; choose another folder or empty it",
                                    path.string(), marker));
    }
    output.temporary = output.resolved.parent_path() / hiddenName(output.resolved, "tmp");
    if (!fs::create_directory(output.temporary, error)) refuse(path, "cannot be made", error.value());
    outputs_.push_back(output);
    resolved_.insert(output.resolved);
    return output.temporary;
}

void OutputSet::commit() {
    const std::lock_guard lock(mutex());
    while (!outputs_.empty()) {
        const Output output = outputs_.front();
        std::error_code error;
        fs::path old;
        if (fs::is_directory(output.temporary, error) && fs::exists(output.resolved, error)) {
            old = output.resolved.parent_path() / hiddenName(output.resolved, "old");
            fs::rename(output.resolved, old, error);
            if (error) refuse(output.path, "cannot be replaced", error.value());
        }
        fs::rename(output.temporary, output.resolved, error);
        if (error) {
            std::error_code ignored;
            if (!old.empty()) fs::rename(old, output.resolved, ignored);
            refuse(output.path, "cannot be put in place", error.value());
        }
        outputs_.erase(outputs_.begin());
        resolved_.erase(output.resolved);
        removeWhole(hiddenFolder(output.resolved, output.temporary));
        if (!old.empty()) fs::remove_all(old, error);
    }
}

std::vector<fs::path> OutputSet::paths() const {
    std::vector<fs::path> result;
    for (const Output& output : outputs_) result.push_back(output.path);
    return result;
}

void OutputSet::discard() noexcept {
    for (const Output& output : outputs_) removeWhole(hiddenFolder(output.resolved, output.temporary));
    outputs_.clear();
    resolved_.clear();
}

void OutputSet::discardAll() {
    const std::lock_guard lock(mutex());
    for (OutputSet* set : allSets()) set->discard();
}

void OutputSet::discardAllForGood() {
    mutex().lock();  // and never unlocked
    for (OutputSet* set : allSets()) set->discard();
}

}  // namespace earthshine
