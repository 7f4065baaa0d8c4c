"""Pictures, tables of hits and checks by several machines.

``python -m cyltrace.farm render SCENE -o OUT`` divides the work of the program ``cyltrace`` into
parts, makes every part as a task of Dask, and merges them: OUT has the bytes that one process
would have written. Workers may join, leave and die; the same command again goes on where an
earlier one ended. Workers need Dask and the program, not this package.

``python -m cyltrace.farm --help`` lists the options. ``pip install cyltrace[farm]`` installs Dask.

- ``_arguments``: the command line;
- ``_program``: the program on this machine, which lists and merges parts;
- ``_folder``: the folder of the parts, and those that are missing;
- ``_bundle``: the files that workers need where they share no folder;
- ``_part``: what a worker does;
- ``_cluster``: connections to Dask;
- ``_driver`` and ``_round``: the tasks, until all parts are there;
- ``_display``: the progress.
"""
