#pragma once
// A film, by ffmpeg: it is started without a shell and gets the frames' bytes through a pipe.

#include <filesystem>

#include <sys/types.h>

#include "earthshine/image.hpp"

namespace earthshine::cli {

/// The ffmpeg on PATH. Throws UsageError if `film` has not the ending of a film, Error if there is no ffmpeg.
std::filesystem::path findFfmpeg(const std::filesystem::path& film);

class Film {
public:
    /// Starts `ffmpeg`, which writes to `temporary` the kind of film that the ending of `path` says. Throws Error if it
    /// cannot be started.
    Film(const std::filesystem::path& ffmpeg, const std::filesystem::path& path, const std::filesystem::path& temporary,
         Extent extent, double framesPerSecond);
    ~Film();  ///< ends it if it still runs
    Film(const Film&) = delete;
    Film& operator=(const Film&) = delete;

    /// Adds a frame: RGBA8, of the film's extent. Throws Error, with what ffmpeg last said, if it has ended.
    void add(const ImageView& frame);

    /// Waits until the film is whole. Throws Error, with what ffmpeg last said, if it failed.
    void finish();

private:
    [[noreturn]] void fail(int status) const;
    int wait();

    std::filesystem::path path_;
    Extent extent_;
    int frames_ = -1;    ///< the end of the pipe
    int messages_ = -1;  ///< a file of what ffmpeg says
    pid_t process_ = -1;
};

}  // namespace earthshine::cli
