#pragma once
// The files and folders that a command makes: they appear whole or not at all.

#include <filesystem>
#include <set>
#include <string>
#include <vector>

namespace earthshine {

/// Every output is first written under a temporary name beside its place; commit() renames them all. Without commit()
/// (an exception, a signal) the temporary ones vanish and what stood there before stays as it was. Announce outputs
/// before long work: whatever can be refused is refused then.
class OutputSet {
public:
    OutputSet();
    ~OutputSet();
    OutputSet(const OutputSet&) = delete;
    OutputSet& operator=(const OutputSet&) = delete;

    /// Announces a file, and returns the temporary path, an empty file so far, to write it to.
    /// Throws UsageError if the set has that path already; Error if its folder is not there or cannot be written to,
    /// or if something that is no file stands in its place.
    std::filesystem::path addFile(const std::filesystem::path& path);

    /// Announces a folder, and returns the temporary folder, empty so far, to fill. One that is there already gets
    /// replaced if it is empty or holds a file `marker` (it is an older one of its kind). Throws as addFile, and Error
    /// for a folder that holds anything else.
    std::filesystem::path addFolder(const std::filesystem::path& path, const std::string& marker);

    /// Puts every output in its place. Throws Error if the file system refuses; at most the ones before are in place.
    void commit();

    /// The paths announced, in order.
    std::vector<std::filesystem::path> paths() const;

    /// Removes the temporary outputs of every set, for good: a path that addFile() gave can no longer be opened.
    /// Thread-safe.
    static void discardAll();

    /// discardAll, after which whoever adds, commits or discards outputs waits forever, so that no new ones appear
    /// before the process ends.
    static void discardAllForGood();

private:
    struct Output {
        std::filesystem::path path, resolved, temporary;
    };
    void announce(const std::filesystem::path& path, Output& output) const;
    void discard() noexcept;

    std::vector<Output> outputs_;
    std::set<std::filesystem::path> resolved_;  ///< of all outputs: a sequence has many
};

}  // namespace earthshine
