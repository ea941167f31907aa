/// The address of a program in a file, for who started it.
#pragma once

#include <string>

#include "plab/result.h"

namespace plab::websocket
{

/// Is there as long as this object. Only its owner may read it: an address with a token is the right to do everything.
class AddressFile
{
public:
    /// `file` empty: none.
    static Result<AddressFile> write(const std::string& file, const std::string& url);
    AddressFile(AddressFile&& other) noexcept;
    AddressFile& operator=(AddressFile&&) = delete;
    ~AddressFile();

private:
    explicit AddressFile(std::string file) : file_(std::move(file)) {}

    std::string file_;
};

}  // namespace plab::websocket
