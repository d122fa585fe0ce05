// SPDX-License-Identifier: Apache-2.0
// The state of a march as bytes, for copies and checkpoints: a class hands its members to a `Writer` or to a `Reader`,
// in one order, by `template <class Archive> void pass(Archive& archive)`.
//
// The FNV-1a checksum of all bytes follows them. Bytes suit one kind of processor.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace eel_core {

inline std::uint64_t checksum(std::string_view bytes)
{
    std::uint64_t sum = 0xcbf29ce484222325u;
    for (const char byte : bytes) sum = (sum ^ static_cast<unsigned char>(byte)) * 0x100000001b3u;
    return sum;
}

class Writer {
  public:
    static constexpr bool reads = false;

    template <class... Parts>
    void operator()(Parts&... parts)
    {
        (put(parts), ...);
    }
    // A value that must equal the reader's.
    void same(std::uint64_t number) { put(number); }

    std::string finished()
    {
        same(checksum(bytes_));
        return std::move(bytes_);
    }

  private:
    template <class Part>
    void put(Part& part)
    {
        if constexpr (std::is_trivially_copyable_v<Part>)
            append(&part, sizeof part);
        else
            part.pass(*this);
    }
    template <class Part>
    void put(std::vector<Part>& parts)
    {
        static_assert(std::is_trivially_copyable_v<Part>);
        same(parts.size());
        append(parts.data(), sizeof(Part) * parts.size());
    }
    template <class Part, std::size_t N>
        requires(!std::is_trivially_copyable_v<Part>)
    void put(std::array<Part, N>& parts)
    {
        for (Part& part : parts) put(part);
    }
    void append(const void* from, std::size_t size) { bytes_.append(static_cast<const char*>(from), size); }

    std::string bytes_;
};

// Throws if the bytes were not written by a `Writer` for the same body and method.
class Reader {
  public:
    static constexpr bool reads = true;

    explicit Reader(std::string_view bytes) : left_(bytes)
    {
        std::uint64_t sum = 0;
        if (bytes.size() < sizeof sum) fail();
        left_.remove_suffix(sizeof sum);
        std::memcpy(&sum, bytes.data() + left_.size(), sizeof sum);
        if (sum != checksum(left_)) fail();
    }

    template <class... Parts>
    void operator()(Parts&... parts)
    {
        (take(parts), ...);
    }
    void same(std::uint64_t number)
    {
        std::uint64_t found = 0;
        take(found);
        if (found != number) fail();
    }
    void finish() const
    {
        if (!left_.empty()) fail();
    }

  private:
    [[noreturn]] static void fail()
    {
        throw std::invalid_argument("state must be that of a march of the same body by the same method");
    }
    template <class Part>
    void take(Part& part)
    {
        if constexpr (std::is_trivially_copyable_v<Part>)
            move_to(&part, sizeof part);
        else
            part.pass(*this);
    }
    template <class Part>
    void take(std::vector<Part>& parts)
    {
        std::uint64_t size = 0;
        take(size);
        if (size > left_.size() / sizeof(Part)) fail();
        parts.resize(size);
        move_to(parts.data(), sizeof(Part) * parts.size());
    }
    template <class Part, std::size_t N>
        requires(!std::is_trivially_copyable_v<Part>)
    void take(std::array<Part, N>& parts)
    {
        for (Part& part : parts) take(part);
    }
    void move_to(void* to, std::size_t size)
    {
        if (size > left_.size()) fail();
        if (size > 0) std::memcpy(to, left_.data(), size);
        left_.remove_prefix(size);
    }

    std::string_view left_;
};

}  // namespace eel_core
