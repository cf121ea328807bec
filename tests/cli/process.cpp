#include "cli/process.hpp"

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <regex>
#include <sstream>
#include <stdexcept>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

extern char** environ;

namespace earthshine::test {

std::string besidesProgress(const std::string& err) {
    static const std::regex kProgress("earthshine: (compiling kernel .*|.*: [0-9]+ %)");
    std::istringstream lines(err);
    std::string rest;
    for (std::string line; std::getline(lines, line);)
        if (!std::regex_match(line, kProgress)) rest += line + "\n";
    return rest;
}

Process::Process(const Arguments& arguments, const std::vector<std::string>& environment,
                 const std::string& programPath) {
    out_ = ::memfd_create("stdout", MFD_CLOEXEC);
    err_ = ::memfd_create("stderr", MFD_CLOEXEC);
    std::string program = programPath;
    std::vector<std::string> words{program};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> argv, env;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    std::vector<std::string> variables = environment;
    for (std::string& variable : variables) env.push_back(variable.data());
    for (char** variable = environ; *variable; ++variable) env.push_back(*variable);
    env.push_back(nullptr);

    pid_ = ::fork();
    if (pid_ < 0) throw std::runtime_error(std::strerror(errno));
    if (pid_ > 0) return;
    ::dup2(::open("/dev/null", O_RDONLY), STDIN_FILENO);
    ::dup2(out_, STDOUT_FILENO);
    ::dup2(err_, STDERR_FILENO);
    ::execve(program.c_str(), argv.data(), env.data());
    ::_exit(127);
}

Process::~Process() {
    if (pid_ > 0) {
        ::kill(pid_, SIGKILL);
        ::waitpid(pid_, nullptr, 0);
    }
    ::close(out_);
    ::close(err_);
}

void Process::signal(int number) const {
    ::kill(pid_, number);
}

std::string Process::read(int file) const {
    std::string text(std::size_t(::lseek(file, 0, SEEK_END)), '\0');
    ::lseek(file, 0, SEEK_SET);
    const ssize_t count = ::read(file, text.data(), text.size());
    text.resize(std::size_t(count < 0 ? 0 : count));
    return text;
}

Result Process::wait() {
    int status = 0;
    ::waitpid(pid_, &status, 0);
    pid_ = -1;
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status), read(out_), read(err_)};
}

Result runEarthshine(const Arguments& arguments, const std::vector<std::string>& environment,
                     const std::string& program) {
    return Process(arguments, environment, program).wait();
}

}  // namespace earthshine::test
