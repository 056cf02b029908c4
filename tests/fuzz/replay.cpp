// Runs a target over inputs that are kept: those that once found a fault, and the corpus.
#include "fuzz/targets.h"
#include "fuzz/working_folder.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

int main(int argc, char** argv)
{
    namespace fs = std::filesystem;
    const fppg::fuzz::Target* target = argc > 2 ? fppg::fuzz::find_target(argv[1]) : nullptr;
    if (target == nullptr)
    {
        std::fprintf(stderr, "usage: %s TARGET FOLDER...\n", argv[0]);
        return 2;
    }
    std::vector<fs::path> inputs;
    for (int i = 2; i < argc; ++i)
        if (fs::is_directory(argv[i]))
            for (const auto& file : fs::directory_iterator(argv[i]))
                inputs.push_back(fs::absolute(file.path()));
    std::sort(inputs.begin(), inputs.end());
    if (inputs.empty())
    {
        std::fprintf(stderr, "%s: no inputs\n", argv[1]);
        return 1;
    }
    fppg::fuzz::enter_working_folder();
    for (const fs::path& input : inputs)
    {
        std::fprintf(stderr, "%s\n", input.c_str());
        std::ifstream file(input, std::ios::binary);
        const std::string bytes((std::istreambuf_iterator<char>(file)),
                                std::istreambuf_iterator<char>());
        fppg::fuzz::run_target(*target, bytes);
    }
    return 0;
}
