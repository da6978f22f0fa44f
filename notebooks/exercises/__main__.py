"""Command line of the instructors' tools; run it in the folder of the notebooks: python -m exercises --help."""
import argparse
from collections import Counter

from . import instructors
from .exam import QUESTIONS


def main(arguments=None):
    parser = argparse.ArgumentParser(prog="python -m exercises", description=instructors.__doc__)
    commands = parser.add_subparsers(dest="command", required=True)
    command = commands.add_parser("handout", help="copy the notebooks without solutions")
    command.add_argument("folder", metavar="FOLDER", help="a new folder, best beside `notebooks` in a clone")
    command = commands.add_parser("exam", help="write an examination, one notebook a student",
                                  epilog="The questions: " + ", ".join(QUESTIONS))
    command.add_argument("numbers", metavar="NUMBER", nargs="*", help="a question, or a notebook for all of its; "
                         "none: all questions")
    command.add_argument("--students", metavar="FILE", required=True, help="names, one a line")
    command.add_argument("--seed", required=True, help="any text; keep it secret, and long enough not to be guessed")
    command.add_argument("--to", metavar="FOLDER", required=True, help="a new folder")
    command = commands.add_parser("grade", help="grade a folder of submitted notebooks")
    command.add_argument("folder", metavar="FOLDER")
    command.add_argument("--seed", required=True, help="that of the examination")
    command.add_argument("--students", metavar="FILE", help="names, to list who has submitted nothing")
    command.add_argument("--to", metavar="FILE", default="marks.csv", help="where to write (default: marks.csv)")
    command.add_argument("--run", action="store_true", help="run the notebooks, with all that their code does to this "
                         "machine, instead of reading the numbers from their source")
    given = parser.parse_args(arguments)
    try:
        if given.command == "handout":
            print(f"{given.folder}: {instructors.handout(given.folder)} notebooks without solutions")
        elif given.command == "exam":
            names = instructors.exam(given.numbers, given.students, given.seed, given.to)
            print(f"{given.to}: {len(names)} notebooks")
        else:
            rows = instructors.grade(given.folder, given.seed, given.students, given.run)
            instructors.write_marks(rows, given.to)
            totals = Counter()
            for student, _, points, _ in rows:
                totals[student] += points
            print("\n".join(f"{student}: {points}" for student, points in totals.items()))
            print(f"written to {given.to}")
    except (OSError, ValueError) as error:
        parser.exit(2, f"{error}\n")


if __name__ == "__main__":
    main()
