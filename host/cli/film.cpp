#include "cli/film.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include "earthshine/error.hpp"

namespace fs = std::filesystem;

namespace earthshine::cli {

namespace {

struct Container {
    std::string_view ending;
    const char* muxer;
};
constexpr std::array<Container, 4> kContainers = {
    {{".mp4", "mp4"}, {".mkv", "matroska"}, {".mov", "mov"}, {".webm", "webm"}}};

/// ffmpeg's name of a kind of film; null if it is none.
const char* muxerOf(const fs::path& path) {
    for (const Container& container : kContainers)
        if (path.extension() == container.ending) return container.muxer;
    return nullptr;
}

/// The last line that is not empty.
std::string lastLine(int file) {
    std::string text(std::size_t(std::max<off_t>(::lseek(file, 0, SEEK_END), 0)), '\0');
    const ssize_t count = ::pread(file, text.data(), text.size(), 0);
    text.resize(std::size_t(std::max<ssize_t>(count, 0)));
    text.erase(text.find_last_not_of("\r\n ") + 1);
    return text.substr(text.find_last_of("\r\n") + 1);
}

}  // namespace

fs::path findFfmpeg(const fs::path& film) {
    if (!muxerOf(film))
        throw UsageError(fmt::format("--film: '{}' must end in .mp4, .mkv, .mov or .webm", film.string()));
    const char* path = std::getenv("PATH");
    std::string_view folders = path ? path : "";
    while (!folders.empty()) {
        const auto colon = std::min(folders.find(':'), folders.size());
        const fs::path candidate = fs::path(folders.substr(0, colon)) / "ffmpeg";
        std::error_code error;
        if (fs::is_regular_file(candidate, error) && ::access(candidate.c_str(), X_OK) == 0) return candidate;
        folders.remove_prefix(std::min(colon + 1, folders.size()));
    }
    throw Error("--film: there is no ffmpeg on PATH; install it, or write numbered pictures (-o out.####.png)");
}

Film::Film(const fs::path& ffmpeg, const fs::path& path, const fs::path& temporary, Extent extent,
           double framesPerSecond)
    : path_(path), extent_(extent) {
    std::vector<std::string> words = {
        ffmpeg.string(), "-hide_banner", "-loglevel", "error", "-y",
        // What comes: RGBA bytes, sRGB.
        "-f", "rawvideo", "-pixel_format", "rgba", "-video_size", fmt::format("{}x{}", extent.widthPx, extent.heightPx),
        "-framerate", fmt::format("{}", framesPerSecond), "-i", "pipe:0",
        // What players expect: 4:2:0, so sides that are even, and the matrix of HD video, said in the file.
        "-vf",
        "pad=ceil(iw/2)*2:ceil(ih/"
        "2)*2,scale=out_color_matrix=bt709:out_range=tv,format=yuv420p,setparams=color_primaries=bt709:color_trc="
        "iec61966-2-1:colorspace=bt709",
        "-colorspace", "bt709", "-color_primaries", "bt709", "-color_trc", "iec61966-2-1", "-color_range", "tv", "-f",
        muxerOf(path), temporary.string()};
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);

    // A socket and no pipe, because only a socket can be written to without a signal if ffmpeg has ended.
    int ends[2];
    messages_ = ::memfd_create("ffmpeg", MFD_CLOEXEC);
    if (messages_ < 0 || ::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0)
        throw Error(fmt::format("--film: ffmpeg cannot be started: {}", std::strerror(errno)));
    frames_ = ends[0];
    const pid_t parent = ::getpid();
    process_ = ::fork();
    if (process_ == 0) {
        // The program has other threads: from here to exec only what a signal's handler may do.
        ::prctl(PR_SET_PDEATHSIG, SIGKILL);  // it shall not write on when the program was ended
        if (::getppid() != parent) ::_exit(127);
        const int nothing = ::open("/dev/null", O_WRONLY);
        ::dup2(ends[1], STDIN_FILENO);
        ::dup2(nothing, STDOUT_FILENO);
        ::dup2(messages_, STDERR_FILENO);
        sigset_t none;
        sigemptyset(&none);
        ::sigprocmask(SIG_SETMASK, &none, nullptr);
        ::execv(argv[0], argv.data());
        ::_exit(127);
    }
    const int forkError = errno;
    ::close(ends[1]);
    ::shutdown(frames_, SHUT_RD);
    if (process_ < 0) {
        ::close(frames_);
        ::close(messages_);
        throw Error(fmt::format("--film: ffmpeg cannot be started: {}", std::strerror(forkError)));
    }
}

Film::~Film() {
    if (frames_ >= 0) ::close(frames_);
    if (process_ > 0) {
        ::kill(process_, SIGKILL);
        wait();
    }
    ::close(messages_);
}

void Film::add(const ImageView& frame) {
    if (frame.format != PixelFormat::RGBA8 || frame.extent != extent_)
        throw UsageError(fmt::format("--film: takes RGBA8 of {} x {}", extent_.widthPx, extent_.heightPx));
    const auto* bytes = static_cast<const char*>(frame.data);
    for (std::size_t done = 0; done < frame.sizeBytes();) {
        const ssize_t count = ::send(frames_, bytes + done, frame.sizeBytes() - done, MSG_NOSIGNAL);
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) {
            ::close(frames_);
            frames_ = -1;
            fail(wait());
        }
        done += std::size_t(count);
    }
}

void Film::finish() {
    ::close(frames_);
    frames_ = -1;
    if (const int status = wait(); status != 0) fail(status);
}

int Film::wait() {
    int status = 0;
    while (::waitpid(process_, &status, 0) < 0 && errno == EINTR) {
    }
    process_ = -1;
    return status;
}

void Film::fail(int status) const {
    const std::string how = WIFSIGNALED(status) ? fmt::format("signal {} ended it", WTERMSIG(status))
                                                : fmt::format("exit code {}", WEXITSTATUS(status));
    const std::string said = lastLine(messages_);
    throw Error(fmt::format("{}: ffmpeg failed ({}){}{}", path_.string(), how, said.empty() ? "" : ": ", said));
}

}  // namespace earthshine::cli
