/// Rows from a file through an index to a file: reads a chunk while another is answered and the one before is
/// written.
#pragma once

#include <algorithm>
#include <atomic>
#include <exception>
#include <string>
#include <utility>
#include <vector>

#include <hedgerow/any_question.h>
#include <hedgerow/io/rows.h>
#include <hedgerow/parallel/executor.h>

#include "progress_line.h"

namespace hedgerow::cli {

/// How rows are cut. A piece is answered by one thread at once.
struct RowCut {
    std::size_t chunk, piece;
};
inline constexpr RowCut cut_for_batches{std::size_t(1) << 15, 4096}, cut_for_lists{std::size_t(1) << 15, 32};

template <class T>
class RowStream {
public:
    /// Answers `count` rows, whose numbers begin at `numbers`; `first` is the first row's number.
    using Answer =
        FunctionRef<void(const T* numbers, std::uint64_t first, std::size_t count, AnsweredRows& answers)>;

    RowStream(RowReader<T>& in, std::size_t columns, RowWriter& out, Executor& executor, RowCut cut)
        : in_(in), columns_(columns), out_(out), executor_(executor), cut_(cut) {}

    /// Answers all rows. Rows before a fault of the input are answered and written before its InputError
    /// leaves. Throws Cancelled once the progress, which counts rows, is cancelled.
    void run(Answer answer, const Progress& progress) {
        Chunk written, now, next;
        read(now);
        try {
            while (now.rows + written.rows > 0) {
                executor_.both(
                    [&] {
                        write(written);
                        read(next);
                    },
                    [&] { this->answer(now, answer, progress); });
                // Answers that are too many for the memory are written as they come.
                while (!now.done()) {
                    write(now);
                    this->answer(now, answer, progress);
                }
                std::swap(written, now);
                std::swap(now, next);
            }
        } catch (const Cancelled&) {
            // Keep what is finished.
            write(written);
            write(now);
            throw;
        }
        if (fault_) std::rethrow_exception(fault_);
    }
    /// The number of rows whose answers were written, and of those among them that can have none.
    std::uint64_t asked() const { return done_; }
    std::uint64_t unusable() const { return unusable_; }
    std::uint64_t first_unusable() const { return first_unusable_; }

private:
    /// The most bytes of answers that wait to be written, beyond those of the pieces at work.
    static constexpr std::size_t most_bytes = std::size_t(1) << 25;

    /// The most bytes of strings that a chunk keeps for the next rows. New memory costs more than the copy of
    /// the answers into it.
    static constexpr std::size_t most_kept = std::size_t(1) << 23;

    struct Piece {
        AnsweredRows answers;
        std::string encoded;
        bool done = false;

        /// Forgets the answers, and keeps memory for others if it is at most so many bytes.
        void start_again(std::size_t most) {
            std::string memory = std::move(encoded);
            memory.clear();
            *this = {};
            if (memory.capacity() <= most) answers.records = std::move(memory);
        }
    };
    struct Chunk {
        std::vector<T> numbers;
        std::uint64_t first = 0;
        std::size_t rows = 0, written = 0;  // written: pieces
        std::vector<Piece> pieces;

        bool done() const {
            return std::all_of(pieces.begin() + static_cast<std::ptrdiff_t>(written), pieces.end(),
                               [](const Piece& p) { return p.done; });
        }
    };

    /// Reads the next rows into a chunk of before, whose memory is used again.
    void read(Chunk& c) {
        c.first = read_;
        c.written = 0;
        try {
            if (fault_)
                c.numbers.clear();
            else
                in_.read(c.numbers, cut_.chunk);
        } catch (...) {
            fault_ = std::current_exception();
        }
        c.rows = c.numbers.size() / columns_;
        read_ += c.rows;
        c.pieces.resize((c.rows + cut_.piece - 1) / cut_.piece);
        for (Piece& p : c.pieces) p.start_again(most_kept / c.pieces.size());
    }
    /// Answers the pieces that are not done, in order, until there are too many answers; but at least one.
    void answer(Chunk& c, Answer answer, const Progress& progress) {
        std::atomic<std::size_t> bytes = 0;
        const std::size_t first = c.written;
        executor_.for_each_piece(c.pieces.size() - first, 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = first + begin; i < first + end; ++i) {
                Piece& p = c.pieces[i];
                if (p.done || (bytes > most_bytes && i > first)) continue;
                progress.look();
                const std::size_t row = i * cut_.piece, count = std::min(cut_.piece, c.rows - row);
                answer(c.numbers.data() + row * columns_, c.first + row, count, p.answers);
                p.encoded = out_.encode(std::move(p.answers.records));
                p.done = true;
                bytes += p.encoded.size();
                progress(answered_ += count, in_.size().value_or(0));
            }
        });
    }
    /// Writes the pieces that are done, as far as none before them is missing.
    void write(Chunk& c) {
        for (; c.written < c.pieces.size() && c.pieces[c.written].done; ++c.written) {
            Piece& p = c.pieces[c.written];
            out_.write(p.encoded, p.answers.rows);
            done_ += std::min(cut_.piece, c.rows - c.written * cut_.piece);
            if (unusable_ == 0) first_unusable_ = p.answers.first_unusable;
            unusable_ += p.answers.unusable;
            if (p.encoded.capacity() > most_kept / c.pieces.size()) p.encoded = {};
        }
    }

    RowReader<T>& in_;
    std::size_t columns_;
    RowWriter& out_;
    Executor& executor_;
    RowCut cut_;
    std::exception_ptr fault_;
    std::uint64_t read_ = 0, done_ = 0, unusable_ = 0, first_unusable_ = 0;
    std::atomic<std::uint64_t> answered_{0};
};

}  // namespace hedgerow::cli
