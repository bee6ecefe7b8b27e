"""The language server: what an editor shows of gait scripts while they are written.

`server.py` speaks the protocol; everything else works on texts and knows no message of it but positions. What is true
of a script is asked of `host.gait` and of the script's robot: nothing of the language is told here a second time.
"""
