"""The gait language: scripts of coil orders, checked on the host and run by the robot's own sequencer.

script = parser.load("gaits/circular-crawl.gait")          # GaitError lists every mistake at once
compiled = compiler.compile_script(script, profile, ["duty=50%"])
report = checker.check(compiled, profile)                  # worst case, held against the robot's limits
"""
