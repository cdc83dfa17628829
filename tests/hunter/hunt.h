/// One round of the hunter: it draws a scene and queries, compares the answers of every structure with those
/// of brute force, and compares these with exact arithmetic.
#pragma once

#include <any>
#include <memory>
#include <sstream>

#include "answers.h"
#include "oracle.h"
#include "report.h"
#include "scenes.h"
#include "shrink.h"

namespace hedgerow::hunter {

/// A structure with random options, whose values are from the list of structures or from the lists below.
inline std::string any_options(const StructureInfo& structure, Random& random) {
    std::string spec(structure.name);
    const auto one_of = [&](auto... values) {
        const std::string all[] = {std::string(values)...};
        return all[random.bits() % sizeof...(values)];
    };
    for (const auto& option : structure.options) {
        // Change one option in four.
        if (random.bits() % 4 != 0) continue;
        std::string value;
        // Draw from the choices that the option has, or from the numbers below.
        if (!option.choices.empty()) {
            value = option.choices[random.bits() % option.choices.size()];
        } else if (option.name == "width") {
            value = one_of("4", "8", "16");
        } else if (option.name == "resolution") {
            value = one_of("1", "2", "3", "7", "16", "33");
        } else if (option.name == "max_depth") {
            value = one_of("1", "4", "16", "30");
        } else if (option.name == "leaf_size" || option.name == "max_leaf_size") {
            value = one_of("1", "2", "4", "8");
        } else if (option.name == "intersection_cost") {
            value = one_of("0.25", "4", "20", "100");
        } else if (option.name == "reinsertion") {
            value = one_of("1", "3");
        } else if (option.name == "overlap") {
            value = one_of("0", "0.1");
        } else if (option.name == "duplicates") {
            value = one_of("1", "3", "10");
        } else if (option.name == "cell") {
            value = one_of("1e-30", "0.001", "1", "1e6", "1e30");
        } else {
            continue;
        }
        spec += (spec.find(':') == std::string::npos ? ':' : ',') + std::string(option.name) + "=" + value;
    }
    return spec;
}

template <class Shape>
class Hunt {
public:
    using Set = decltype(set_of(std::vector<Shape>()));
    using T = typename Set::Scalar;
    static constexpr int D = Set::dimension;

    Hunt(std::uint64_t seed, std::uint64_t round) : seed_(seed), round_(round), random_(seed, round) {}

    Report run() {
        Places<T, D> places(random_);
        shapes_ = scene<Shape>(places);
        Asking<T, D> asking(places, corners_of(shapes_, Vec<T, D>()));
        questions_ = asking.questions(256, 64);
        set_ = set_of(shapes_);
        oracle_ = build_any("brute-force", set_);
        answer_all(*oracle_);
        hold_brute_force_against_exact_arithmetic();
        constexpr std::size_t enough = 3;  // a round often finds one fault many times
        for (const auto& structure : structure_list()) {
            if (report_.found.size() >= enough) break;
            if (!structure.holds(D, PointSet<ViewOf<Set>>)) continue;
            look_at(std::string(structure.name));
            for (int i = 0; i < 3; ++i) look_at(any_options(structure, random_));
        }
        return std::move(report_);
    }

private:
    /// Answers of brute force to each question, in the order of for_each_hunted_question: a vector each.
    void answer_all(const AnyIndex<T, D>& oracle) {
        for_each_hunted_question<T, D>([&]<class Question>(Question) {
            truth_.emplace_back();
            if constexpr (answered_by<Question, Set>) {
                using Given = typename Question::Given;
                std::vector<Given> given;
                for (const Given& g : questions_.template given<Given>()) given.push_back(exactly(g));
                truth_.back() = answers_to<Question>(oracle, given);
                report_.questions += given.size();
            }
        });
    }

    /// Builds a structure and compares its answers. One time in four, compares again after a change that
    /// leaves the primitives the same.
    void look_at(const std::string& spec) {
        std::unique_ptr<AnyIndex<T, D>> index;
        try {
            index = build_any(spec, set_);
        } catch (const InputError& e) {
            // A refusal counts as an answer: options may contradict each other, or memory be exceeded.
            ++report_.questions;
            return;
        }
        if (!compare(spec, *index, Then::nothing) || random_.bits() % 4 != 0) return;
        const auto then = random_.bits() % 2 == 0 ? Then::erased_and_inserted : Then::refitted;
        if (carry_out(then, *index)) compare(spec, *index, then);
    }
    /// Reports the first fault, if any. Returns false if there is one.
    bool compare(const std::string& spec, const AnyIndex<T, D>& index, Then then) {
        if (const auto fault = index.validate(); !fault.empty()) return invalid(spec, fault, then), false;
        std::size_t number = 0;
        bool equal = true;
        for_each_hunted_question<T, D>([&]<class Question>(Question) {
            const std::any& truth = truth_[number++];
            if constexpr (answered_by<Question, Set>)
                if (equal && answers<Question>(index))
                    equal = compare_answers<Question>(spec, index, then, truth);
        });
        return equal && compare_regions(spec, index, then);
    }
    /// Asks all in one batch, and some alone: kernels answer single questions in another way than batches.
    template <class Question>
    bool compare_answers(const std::string& spec, const AnyIndex<T, D>& index, Then then,
                         const std::any& of_truth) {
        using Given = typename Question::Given;
        const auto& given = questions_.template given<Given>();
        const auto& truth = std::any_cast<const std::vector<typename Question::Answer>&>(of_truth);
        const auto said = answers_to<Question>(index, given);
        report_.questions += given.size();
        for (std::size_t i = 0; i < given.size(); ++i) {
            bool equal = agrees<Given, typename Question::Answer>(given[i], said[i], truth[i]);
            if (AsksMany<Question> && spec.starts_with("wide") && i % 4 == 0) {
                ++report_.questions;
                const auto alone = answers_to<Question>(index, {&given[i], 1});
                equal = equal && agrees<Given, typename Question::Answer>(given[i], alone[0], truth[i]);
            }
            if (!equal) return differs(spec, given[i], then, Question::words), false;
        }
        return true;
    }
    /// Asks about the regions that are no boxes or balls.
    bool compare_regions(const std::string& spec, const AnyIndex<T, D>& index, Then then) {
        for (const auto& region : questions_.regions) {
            report_.questions += 4;
            if (!same_answers(index, *oracle_, region)) return differs(spec, region, then, "regions"), false;
        }
        return true;
    }

    void invalid(const std::string& spec, const std::string& fault, Then then) {
        auto shapes = shapes_;
        Vec<T, D> nothing;
        shrink(shapes, nothing, [&](const std::vector<Shape>& some, const Vec<T, D>&) {
            return guarded([&] {
                const auto set = set_of(some);
                const auto index = build_any(spec, set);
                carry_out(then, *index);
                return !index->validate().empty();
            });
        });
        print("// validate(): " + fault, shapes, nothing, expected(spec, then));
    }
    template <class Question>
    void differs(const std::string& spec, Question question, Then then, std::string_view words) {
        auto shapes = shapes_;
        const auto fails = [&](const std::vector<Shape>& some, const Question& asked) {
            return guarded([&] { return !as_brute_force(spec, some, asked, then); });
        };
        std::string remark = "// " + std::string(words);
        if (fails(shapes, question))
            shrink(shapes, question, fails);
        else
            remark += ", in a batch only, of " + std::to_string(questions_.template given<Question>().size());
        print(remark, shapes, question, expected(spec, then));
    }
    template <class F>
    static bool guarded(F f) {
        try {
            return f();
        } catch (const InputError&) {
            return false;
        }
    }
    static std::string expected(const std::string& spec, Then then) {
        constexpr const char* changes[] = {"", ", Then::erased_and_inserted", ", Then::refitted"};
        return "as_brute_force(\"" + spec + "\", shapes, question" + changes[static_cast<std::size_t>(then)] +
               ")";
    }
    /// Reports a fault as a test that fails.
    template <class Question>
    void print(const std::string& remark, const std::vector<Shape>& shapes, const Question& question,
               const std::string& expected) {
        std::ostringstream out;
        out << "// Seed " << seed_ << ", round " << round_ << ".\nTEST(Found, Round" << seed_ << 'x' << round_
            << ") {\n";
        if (!remark.empty()) out << "    " << remark << '\n';
        out << "    const std::vector<" << name_of(shapes[0]) << "> shapes = {\n";
        for (const auto& shape : shapes) {
            out << "        ";
            write(out, shape);
            out << ",\n";
        }
        out << "    };\n    const " << name_of(question) << " question = ";
        write(out, question);
        out << ";\n    EXPECT_TRUE(" << expected << ");\n}\n";
        report_.found.push_back(out.str());
    }

    /// Checks brute force: a few boxes against all shapes but points, and a few rays against triangles.
    void hold_brute_force_against_exact_arithmetic() {
        if constexpr (!std::is_same_v<Shape, Vec<T, D>>)
            for (std::size_t i = 0; i < questions_.boxes.size(); i += 8)
                check(questions_.boxes[i],
                      answers_to<AskOverlap<Box<T, D>>>(*oracle_, {&questions_.boxes[i], 1})[0]);
        if constexpr (std::is_same_v<Shape, Triangle<T, 3>>)
            for (std::size_t i = 0; i < questions_.rays.size(); i += 16)
                check(questions_.rays[i],
                      answers_to<AskAllHits<T, D>>(*oracle_, {&questions_.rays[i], 1})[0]);
    }
    void check(const Box<T, D>& box, const std::vector<PrimitiveId>& overlapping) {
        for (std::size_t s = 0; s < shapes_.size(); ++s) {
            ++report_.checked_exactly;
            const bool said = std::binary_search(overlapping.begin(), overlapping.end(), s);
            if (said != rational::overlap(shapes_[s], box))
                print("", {shapes_[s]}, box, "is_exact(shapes[0], question)");
        }
    }
    void check(const Ray<T, 3>& ray, const std::vector<Hit<T>>& all) {
        for (int k = 0; k < 3; ++k)
            if (!(std::abs(ray.origin[k]) <= largest_coordinate<T>) ||
                !(std::abs(ray.direction[k]) <= largest_coordinate<T>) ||
                (ray.direction[k] != 0 && !std::isnormal(ray.direction[k])))
                return;  // the query means another ray, or none
        if (!(ray.t_min <= ray.t_max) || !std::isfinite(ray.t_min) ||
            !(max_component(abs(ray.direction)) > 0))
            return;
        for (std::size_t s = 0; s < shapes_.size(); ++s) {
            ++report_.checked_exactly;
            std::optional<T> t;
            for (const auto& hit : all)
                if (hit.element == s) t = hit.t;
            if (t && !std::isfinite(*t)) continue;  // t is beyond the range of T, like the exact crossing
            if (const auto fault = wrong(shapes_[s], ray, t); !fault.empty())
                print("// " + fault, {shapes_[s]}, ray, "is_exact(shapes[0], question)");
        }
    }

    std::uint64_t seed_, round_;
    Random random_;
    Set set_;
    std::vector<Shape> shapes_;
    AllGiven<T, D> questions_;
    std::unique_ptr<const AnyIndex<T, D>> oracle_;
    std::vector<std::any> truth_;
    Report report_;
};

}  // namespace hedgerow::hunter
