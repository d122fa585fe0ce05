"""The paper's figures made again from our own runs, and tables beside them: the command `figures`.

Needs matplotlib, which is imported only to draw; nothing else in the library needs this package.
"""
