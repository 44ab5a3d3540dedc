! Put the macro that builds your model here.
